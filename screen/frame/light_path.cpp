#include "screen/frame/light_path.h"

#include <vector>

namespace volgi::screen {

const char* in_words(LightPath path) {
  switch (path) {
    case LightPath::emission_seen:
      return "emissive surfaces seen by the camera";
    case LightPath::punctual_direct:
      return "direct light of punctual lights";
    case LightPath::emission_direct:
      return "light straight from emissive surfaces";
    case LightPath::punctual_first:
      return "the first reflection of punctual light";
    case LightPath::emission_first:
      return "the first reflection of emission";
    case LightPath::punctual_higher:
      return "higher bounces of punctual light";
    case LightPath::emission_higher:
      return "higher bounces of emission";
    case LightPath::sky_seen:
      return "the sky seen by the camera";
    case LightPath::sky_direct:
      return "light straight from the sky";
    case LightPath::sky_first:
      return "the first reflection of sky light";
    case LightPath::sky_higher:
      return "higher bounces of sky light";
  }
  return "";
}

std::string in_words(LightPaths paths) {
  std::vector<const char*> words;
  for (int k = 0; k < LIGHT_PATH_COUNT; ++k) {
    if (paths.contains(LightPath(k))) words.push_back(in_words(LightPath(k)));
  }
  std::string text;
  for (size_t k = 0; k < words.size(); ++k) {
    if (k > 0) text += k + 1 == words.size() ? " and " : ", ";
    text += words[k];
  }
  return text;
}

LightPaths asked_paths(LightPart part, std::optional<int> bounces) {
  LightPaths asked = LightPaths::all();
  if (part == LightPart::direct || bounces == 0) asked = DIRECT_PATHS;
  if (part == LightPart::indirect) asked = asked & INDIRECT_PATHS;
  if (bounces == 1)
    asked = asked - LightPaths{LightPath::punctual_higher, LightPath::emission_higher, LightPath::sky_higher};
  return asked;
}

}  // namespace volgi::screen
