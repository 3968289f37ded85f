#include "apps/demo/render_command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cstring>

#include "apps/demo/parameter_text.h"
#include "apps/volgi/reading_options.h"
#include "apps/volgi/volume_options.h"
#include "core/error.h"
#include "screen/frame/quality.h"
#include "screen/frame/registry.h"

namespace volgi::demo {

namespace {

using Arguments = std::vector<std::string>;

/// As a shell takes it.
std::string quoted(const std::string& text) {
  const auto plain = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || std::strchr("-_./,:=+", c);
  };
  if (!text.empty() && std::all_of(text.begin(), text.end(), plain)) return text;
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

void add_volume(const VolumeOptions& volume, bool grid_fits_scene, Arguments& out) {
  const VolumeOptions usual;
  const auto add = [&](const char* name, const auto& value) {
    out.insert(out.end(), {name, fmt::format("{}", value)});
  };
  if (!grid_fits_scene) add("--grid", volume.grid_cells);
  if (volume.scheme.scheme != usual.scheme.scheme) add("--scheme", app::scheme_name(volume.scheme.scheme));
  if (volume.scheme.sh_order != usual.scheme.sh_order) add("--sh-order", volume.scheme.sh_order);
  if (volume.scheme.directions) add("--directions", *volume.scheme.directions);
  if (volume.iterations) add("--iterations", *volume.iterations);
}

void add_light(const Document& document, const std::filesystem::path& light_file, Arguments& out) {
  const app::LightOptions& light = document.light_options();
  if (!light_file.empty()) {
    out.insert(out.end(), {"--lights", light_file.string()});
  } else {
    for (const std::string& lamp : light.lamps) out.insert(out.end(), {"--lamp", lamp});
    for (const std::string& sun : light.suns) out.insert(out.end(), {"--sun", sun});
    if (light.lamp_scale != 1.0) out.insert(out.end(), {"--lamp-scale", fmt::format("{}", light.lamp_scale)});
  }
  if (!light.sky.empty()) out.insert(out.end(), {"--sky", light.sky});
  if (light.sky_rotate_deg != 0.0) out.insert(out.end(), {"--sky-rotate", fmt::format("{}", light.sky_rotate_deg)});
  if (light.materials != "gltf") out.insert(out.end(), {"--materials", light.materials});
}

void add_words(const std::string& text, Arguments& out) {
  for (size_t at = 0; at < text.size();) {
    const size_t end = std::min(text.find(' ', at), text.size());
    out.push_back(text.substr(at, end - at));
    at = end + 1;
  }
}

}  // namespace

Arguments frame_arguments(const screen::FrameOptions& options, bool grid_fits_scene) {
  Arguments out;
  if (!options.recipe.empty()) out.insert(out.end(), {"--gi", options.recipe});
  for (const std::string& stage : options.without) out.insert(out.end(), {"--without", stage});
  if (options.light != screen::LightPart::full)
    out.insert(out.end(), {"--light", options.light == screen::LightPart::direct ? "direct" : "indirect"});
  if (options.bounces) out.insert(out.end(), {"--bounces", fmt::format("{}", *options.bounces)});
  if (options.backend != screen::Backend::automatic)
    out.insert(out.end(), {"--backend", options.backend == screen::Backend::gpu ? "gpu" : "cpu"});
  add_volume(options.of<VolumeOptions>(), grid_fits_scene, out);
  for (const auto& [parameter, text] : parameters_set(options))
    out.insert(out.end(), {"--set", fmt::format("{}={}", parameter->name, text)});
  return out;
}

std::string render_command(const Session& session, const std::filesystem::path& out,
                           const std::filesystem::path& light_file) {
  const Document& document = session.document();
  const Settings& settings = session.settings();
  if (document.files().size() > 1)
    throw Error(ExitCode::usage,
                "no command: `volgi render` takes one file, and this scene is made of " + document.title());
  Arguments all{document.files().front().string(), "-o", out.string(), "--size",
                fmt::format("{}x{}", session.size().x, session.size().y)};
  const Arguments reading = app::ReadingOptions::arguments(document.reading());
  all.insert(all.end(), reading.begin(), reading.end());
  add_words(session.camera_arguments(), all);  // numbers and options: nothing to quote
  if (document.animated()) {
    all.insert(all.end(), {"--time", fmt::format("{}", document.time_s())});
    if (document.moves()) all.push_back("--whole-animation");
  }
  const Arguments film = document.light_options().video.arguments();
  all.insert(all.end(), film.begin(), film.end());
  add_light(document, light_file, all);
  const Arguments frame = frame_arguments(settings.frame, settings.grid_fits_scene);
  all.insert(all.end(), frame.begin(), frame.end());
  // What nobody has chosen here `volgi render` would choose.
  const auto chosen = parameters_set(settings.frame);
  for (const std::string& value : screen::values_left_alone(screen::Needs{}, settings.frame)) {
    const std::string name = value.substr(0, value.find('='));
    const bool said = std::any_of(chosen.begin(), chosen.end(), [&](const auto& c) { return c.first->name == name; });
    if (!said) all.insert(all.end(), {"--set", value});
  }
  // Said always: without it `volgi render` averages several where something is half transparent.
  all.insert(all.end(), {"--samples", fmt::format("{}", std::max(session.picture().samples(), 1))});
  all.insert(all.end(), {"--exposure", fmt::format("{:g}", session.exposure_ev())});
  std::string command = "volgi render";
  for (const std::string& argument : all) command += ' ' + quoted(argument);
  return command;
}

}  // namespace volgi::demo
