#include "apps/report/front.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "apps/report/machine.h"
#include "apps/report/renderers.h"
#include "apps/report/report_scene.h"
#include "apps/report/sweep.h"
#include "apps/volgi/frame_options.h"
#include "apps/volgi/light_options.h"
#include "apps/volgi/picture_facts.h"
#include "core/error.h"
#include "core/progress.h"

namespace volgi::app {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double QUIETEST = 0.1;  // share of a setting's points

std::string label_of(const Json& point) {
  const std::string varied = point.at("varied").get<std::string>();
  return point.at("technique").get<std::string>() + (varied.empty() ? "" : " " + varied);
}

int pictures_of(const std::vector<std::string>& options) {
  const auto at = std::find(options.begin(), options.end(), "--quality");
  if (at == options.end() || at + 1 == options.end()) return 1;
  return screen::needs_of(screen::quality_from_name(at[1]), 0, {}).samples;
}

bool is_software(const Json& point) { return point.at("timer") == "wall"; }

/// Clock over processor time of a setting where the machine was quietest; 1 where points have no processor time.
std::map<std::string, double> clock_shares(const std::vector<Json>& points) {
  std::map<std::string, std::vector<double>> all;
  for (const Json& p : points) {
    if (!p.contains("cpu_ms") || !is_software(p)) continue;
    all[label_of(p)].push_back(p["frame_ms"]["min"].get<double>() / p["cpu_ms"].get<double>());
    if (p.contains("times_at"))
      all[label_of(p)].push_back(p["times_at"]["frame_ms"]["min"].get<double>() /
                                 p["times_at"]["cpu_ms"].get<double>());
  }
  std::map<std::string, double> shares;
  for (auto& [setting, values] : all) {
    std::sort(values.begin(), values.end());
    shares[setting] = std::min(1.0, values[size_t(QUIETEST * double(values.size() - 1))]);
  }
  return shares;
}

std::optional<double> error_of(const Json& point) {
  if (!point.contains("metrics")) return std::nullopt;
  for (const char* key : {"rmse_pct_denoised", "rmse_pct"}) {
    const auto found = point["metrics"].find(key);
    if (found != point["metrics"].end() && found->is_number()) return found->get<double>();
  }
  return std::nullopt;
}

void take(screen::FrontPoint& out, const Json& point, double clock_share) {
  const auto time = [&](const Json& times) {
    return is_software(point) && times.contains("cpu_ms") ? clock_share * times["cpu_ms"].get<double>()
                                                          : times["frame_ms"]["median"].get<double>();
  };
  const bool indirect = point.at("light") == "indirect";
  (indirect ? out.indirect_error_percent : out.error_percent) = error_of(point);
  if (point.contains("frame_ms") && (indirect || !out.ms)) out.ms = time(point);
  if (point.contains("times_at")) out.large_ms = time(point["times_at"]);
}

/// Light that `volgi report` has added.
AddedLight added_light(const std::string& arguments) {
  if (arguments.empty()) return {};
  CLI::App command;
  LightOptions options;
  options.add_to(command);
  std::vector<std::string> words = words_of(arguments);
  std::reverse(words.begin(), words.end());
  command.parse(words);
  return {arguments, [options](Scene& scene) { options.apply(scene); }, {}};
}

screen::PictureFacts facts_of(const Json& point, const fs::path& data) {
  const std::string name = point.at("scene").get<std::string>();
  const glm::ivec2 size(point.at("size").at(0).get<int>(), point.at("size").at(1).get<int>());
  const fs::path of_others = data / "reference/scenes" / (name + ".glb");  // not listed: another renderer's references
  const ReportScene scene =
      open_report_scene(fs::is_regular_file(of_others) && name != "cornell" ? of_others.string() : name, data, size,
                        added_light(point.value("light_arguments", std::string())));
  screen::FrameOptions options;
  const FrameCommandOptions usual;
  const auto fitted = usual.fit(scene.scene, glm::vec3(scene.camera.world_from_camera[3]), 0, options);
  return picture_facts(scene.scene, scene.camera, fitted.facts, options.of<VolumeOptions>().grid_box);
}

double pixels_of(const Json& size) { return size.at(0).get<double>() * size.at(1).get<double>(); }

}  // namespace

screen::MeasuredFront front_of_points(const std::vector<Json>& points, const fs::path& data) {
  screen::MeasuredFront front;
  const std::map<std::string, double> shares = clock_shares(points);
  std::map<std::string, size_t> setting_at, scene_at;
  for (const Json& p : points) {
    if (p.at("renderer") != "render" || !p.contains("frame_ms")) continue;
    const auto options = p.at("options").get<std::vector<std::string>>();
    if (setting_at.try_emplace(label_of(p), front.settings.size()).second)
      front.settings.push_back({label_of(p), options, pictures_of(options)});
    if (p.contains("times_at")) front.large_pixels = pixels_of(p["times_at"]["size"]);
    front.pixels = pixels_of(p.at("size"));
    front.device = p.at("device").get<std::string>();
    front.machine = p.at("machine").get<std::string>();
    front.date = p.at("date").get<std::string>();
  }
  if (front.settings.empty() || front.large_pixels == 0.0)
    throw Error(ExitCode::bad_input, "no points with times at two sizes; volgi report --sweep data/report/auto.json");
  Progress progress("facts", 0);
  for (const Json& p : points) {
    const auto setting = setting_at.find(label_of(p));
    if (setting == setting_at.end()) continue;
    const std::string name = p.at("scene").get<std::string>();
    const auto [at, is_new] = scene_at.try_emplace(name, front.scenes.size());
    if (is_new) {
      front.scenes.push_back({name, facts_of(p, data), std::vector<screen::FrontPoint>(front.settings.size())});
    }
    const auto share = shares.find(label_of(p));
    take(front.scenes[at->second].points[setting->second], p, share == shares.end() ? 1.0 : share->second);
  }
  return front;
}

DeviceTimes measure_device(const screen::MeasuredFront& front, const fs::path& path, gl::Context& context) {
  const glm::ivec2 small(int(std::lround(std::sqrt(front.pixels)))),
      large(int(std::lround(std::sqrt(front.large_pixels))));
  const ReportScene scene = open_report_scene(path.string(), "", small);
  const Renderer render = standard_renderers().at("render");
  DeviceTimes out{context.device_name(), machine_name(), date_now(), {}};
  Progress progress("calibrate", front.settings.size());
  for (const screen::FrontSetting& setting : front.settings) {
    const int frames = setting.pictures > 1 ? 1 : 5;
    const auto ms = [&](glm::ivec2 size) {
      return render({scene.scene, scene.camera, size, "indirect", frames, setting.options, context})
          .min_ms;  // of frames: what else the machine does is not the device's
    };
    out.times.push_back({scene.name, setting.name, ms(small), {}});
    if (setting.pictures == 1) out.times.back().large_ms = ms(large);
    progress.advance();
  }
  return out;
}

}  // namespace volgi::app
