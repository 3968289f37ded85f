#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/report/renderers.h"
#include "apps/report/report_scene.h"
#include "apps/report/sweep.h"

namespace volgi::app {

/// A picture that somebody else's renderer made of a report's scene: NAME=FILE.exr[:MS].
struct AddedPicture {
  std::string technique;     // as the page shall name it
  std::string file;          // {scene} and {light} stand for a scene's name, and for full or indirect
  std::optional<double> ms;  // of a frame, as whoever made it measured it

  bool of_any_scene() const { return file.find("{scene}") != std::string::npos; }
};

/// @throws Error(usage) saying what is wrong with the text.
AddedPicture parse_added_picture(std::string_view text);

/// A setting for every picture that is there, of one scene and light each. A file without {light} holds full light, one
/// without {scene} belongs to the only scene.
/// @throws Error(usage) where there are several scenes and the file does not say which; Error(bad_input) where no file
///   is there, is none of EXR, or has another size than the report, naming it.
std::vector<Setting> settings_of(const AddedPicture& picture, const std::vector<ReportScene>& scenes, glm::ivec2 size);

/// The name of the renderer of such settings, which reads the file that their options name.
constexpr const char* ADDED_PICTURE = "picture";
Rendering read_added_picture(const RenderTask& task);

}  // namespace volgi::app
