#include "apps/report/added_picture.h"

#include <fmt/format.h>

#include <cmath>

#include "apps/report/machine.h"
#include "apps/volgi/parse_number.h"
#include "core/error.h"
#include "core/image.h"

namespace volgi::app {
namespace {

namespace fs = std::filesystem;

std::string with(std::string text, std::string_view placeholder, const std::string& value) {
  for (size_t at = text.find(placeholder); at != std::string::npos; at = text.find(placeholder, at + value.size()))
    text.replace(at, placeholder.size(), value);
  return text;
}

void check_size(const fs::path& file, glm::ivec2 size) {
  const Image image = read_exr_rgb(file);
  if (image.width == size.x && image.height == size.y) return;
  throw Error(ExitCode::bad_input,
              fmt::format("--add-picture {}: {} x {} pixels; the report's pictures have {} x {} (--size)",
                          file.string(), image.width, image.height, size.x, size.y));
}

Setting setting_of(const AddedPicture& picture, const std::string& file, const std::string& scene,
                   const std::string& light) {
  Setting setting;
  setting.technique = picture.technique;
  setting.renderer = ADDED_PICTURE;
  // What the file holds is part of what the point is known by.
  setting.options = {"--file", file, "--content", hex(scene_hash(file))};
  if (picture.ms) setting.options.insert(setting.options.end(), {"--ms", fmt::format("{}", *picture.ms)});
  setting.lights = {light};
  setting.scenes = {scene};
  return setting;
}

std::optional<std::string> option(const std::vector<std::string>& options, std::string_view name) {
  for (size_t i = 0; i + 1 < options.size(); i += 2) {
    if (options[i] == name) return options[i + 1];
  }
  return std::nullopt;
}

}  // namespace

AddedPicture parse_added_picture(std::string_view text) {
  const size_t equals = text.find('=');
  const auto wrong = [&](const char* what) {
    return Error(ExitCode::usage,
                 fmt::format("--add-picture {}: {}; give NAME=FILE.exr or NAME=FILE.exr:MS", text, what));
  };
  if (equals == std::string_view::npos || equals == 0) throw wrong("no name");
  AddedPicture picture{std::string(text.substr(0, equals)), std::string(text.substr(equals + 1)), {}};
  const size_t colon = picture.file.rfind(':');
  if (colon != std::string::npos) {
    picture.ms = parse_number<double>(std::string_view(picture.file).substr(colon + 1));
    if (!picture.ms || !(*picture.ms > 0.0) || !std::isfinite(*picture.ms)) throw wrong("its time is no number of ms");
    picture.file.resize(colon);
  }
  if (!picture.file.ends_with(".exr") && !picture.file.ends_with(".EXR")) throw wrong("no EXR");
  return picture;
}

std::vector<Setting> settings_of(const AddedPicture& picture, const std::vector<ReportScene>& scenes, glm::ivec2 size) {
  if (scenes.size() > 1 && !picture.of_any_scene())
    throw Error(ExitCode::usage,
                fmt::format("--add-picture {}={}: of which of {} scenes? Put {{scene}} into the file's "
                            "name, or report one scene",
                            picture.technique, picture.file, scenes.size()));
  std::vector<Setting> settings;
  const bool of_any_light = picture.file.find("{light}") != std::string::npos;
  for (const ReportScene& scene : scenes) {
    for (const char* light : {"full", "indirect"}) {
      if (!of_any_light && light == std::string_view("indirect")) continue;
      const std::string file = with(with(picture.file, "{scene}", scene.name), "{light}", light);
      if (!fs::is_regular_file(file)) continue;
      check_size(file, size);
      settings.push_back(setting_of(picture, file, scene.name, light));
    }
  }
  if (settings.empty())
    throw Error(ExitCode::bad_input, fmt::format("--add-picture {}={}: no such file", picture.technique, picture.file));
  return settings;
}

Rendering read_added_picture(const RenderTask& task) {
  Rendering out;
  out.picture = read_exr_rgb(option(task.options, "--file").value());
  if (const auto ms = option(task.options, "--ms")) {
    out.min_ms = out.median_ms = out.max_ms = parse_number<double>(*ms).value();
    out.timer = "as told";
  }
  return out;
}

}  // namespace volgi::app
