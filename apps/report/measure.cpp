#include "apps/report/measure.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "apps/report/added_picture.h"
#include "apps/report/machine.h"
#include "apps/volgi/metrics_json.h"
#include "apps/volgi/scene_options.h"
#include "core/error.h"
#include "reference/error_map.h"
#include "reference/flip.h"

namespace volgi::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double kShownMean = 0.3;  // of a picture's reference, after exposure

float exposure_of(const ReportReference& reference) {
  double sum = 0;
  int count = 0;
  for (size_t i = 0; i < reference.mask.size(); ++i) {
    if (reference.mask[i] == 0) continue;
    const glm::dvec3 c(reference.file.color.pixels[i]);
    sum += (c.x + c.y + c.z) / 3;
    ++count;
  }
  return sum > 0 ? float(std::log2(kShownMean * count / sum)) : 0.0f;
}

int frames_of(const Setting& setting, const MeasureContext& context) { return setting.frames.value_or(context.frames); }

std::string command_of(const ReportScene& scene, const Setting& setting, const RenderTask& task,
                       const MeasureContext& context) {
  const int count = frames_of(setting, context);
  if (setting.renderer == ADDED_PICTURE) return fmt::format("cp {} point.exr", setting.options.at(1));
  const bool frames = setting.renderer == "render";
  std::vector<std::string> options = setting.options;
  if (frames) {
    for (const std::string& o : options_left_alone(task)) options.push_back(o);
  }
  return fmt::format("volgi {} {}{} {} --light {} --size {}x{}{} -o point.exr{}", setting.renderer, scene.path.string(),
                     scene.light_arguments, fmt::join(options, " "), task.light, context.size.x, context.size.y,
                     frames ? fmt::format(" --frames {}", count) : "", frames ? " --stats point.json" : "");
}

Image scaled(Image picture, double factor) {
  for (glm::vec3& pixel : picture.pixels) pixel *= float(factor);
  return picture;
}

// The figures of `volgi compare`, FLIP among them, and the error that is left when the best constant factor is applied.
Json figures(const Image& picture, const ReportReference& reference) {
  const Image* noise = reference.file.noise ? &*reference.file.noise : nullptr;
  const Metrics metrics = measure(reference.file.color, picture, noise, reference.mask);
  Json json = to_json(metrics);
  if (!metrics.relative) return json;
  const Metrics rescaled =
      measure(reference.file.color, scaled(picture, metrics.relative->scale), noise, reference.mask);
  if (const std::optional<FlipMap> flip = flip_hdr(reference.file.color, picture))
    json["flip"] = flip->mean(reference.mask);
  json["rmse_pct_scaled"] = rescaled.relative->rmse_pct_denoised.value_or(rescaled.relative->rmse_pct);
  return json;
}

void judge(Json& point, const Image& picture, const ReportReference& all_bounces, const ReportReference* one_bounce) {
  Json metrics = figures(picture, all_bounces);
  const int bad = metrics.at("nonfinite").get<int>();
  if (bad > 0) {
    point["error"] = fmt::format("{} of {} pixels are NaN or infinite", bad, picture.pixels.size());
    return;
  }
  point["metrics"] = std::move(metrics);
  if (one_bounce == nullptr) return;
  point["one_bounce_reference"] = one_bounce->path.string();
  point["one_bounce_metrics"] = figures(picture, *one_bounce);
}

bool takes_more_times(const Setting& setting, const std::string& light) {
  return !setting.times_at.empty() && light == setting.lights.front();
}

Json times_json(const Rendering& rendering) {
  return {{"min", rendering.min_ms}, {"median", rendering.median_ms}, {"max", rendering.max_ms}};
}

void add_times(Json& point, const Rendering& rendering) {
  if (rendering.timer.empty()) return;  // nobody has measured it
  point["timer"] = rendering.timer;
  point["frame_ms"] = times_json(rendering);
  point["cpu_ms"] = rendering.cpu_ms;
  point["passes"] = rendering.passes;
  point["memory_bytes"] = rendering.memory_bytes ? Json(*rendering.memory_bytes) : Json();
}

/// Radiance in a PNG that a browser hands on byte by byte: on the left the mantissas, on the right the exponent of
/// Ward's shared-exponent pixels ("Real Pixels", Graphics Gems II, 1991). To 1/256 of a pixel's largest channel.
Image radiance_bytes(const Image& picture) {
  Image out(2 * picture.width, picture.height);
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const glm::vec3 color = glm::max(picture.at(x, y), glm::vec3(0.0f));
      int exponent = 0;
      std::frexp(std::max({color.x, color.y, color.z}), &exponent);
      if (!(std::max({color.x, color.y, color.z}) > 1e-30f)) continue;
      const glm::vec3 mantissas = glm::min(glm::round(color * std::ldexp(1.0f, 8 - exponent)), glm::vec3(255.0f));
      out.at(x, y) = mantissas / 255.0f;
      out.at(picture.width + x, y) = glm::vec3(float(exponent + 128) / 255.0f);
    }
  }
  return out;
}

void write_pictures(Json& point, const Image& picture, const ReportReference& reference, const fs::path& folder) {
  const std::string name = "pictures/" + point.at("key").get<std::string>();
  const float exposure = exposure_of(reference);
  fs::create_directories(folder / "pictures");
  write_png(folder / (name + ".png"), picture, exposure);
  write_png_display(folder / (name + "-radiance.png"), radiance_bytes(picture));
  write_png_display(folder / (name + "-error.png"), error_colors(reference.file.color, picture, reference.mask));
  point["exposure_ev"] = exposure;
  point["picture"] = name + ".png";
  point["radiance_picture"] = name + "-radiance.png";
  point["error_picture"] = name + "-error.png";
}

}  // namespace

Json point_identity(const ReportScene& scene, const Setting& setting, const std::string& light,
                    const MeasureContext& context) {
  const bool added = setting.renderer == ADDED_PICTURE;
  Json identity{{"scene", scene.name},
                {"scene_hash", scene.hash},
                {"technique", setting.technique},
                {"renderer", setting.renderer},
                {"options", setting.options},
                {"light", light},
                {"size", {context.size.x, context.size.y}},
                {"frames", frames_of(setting, context)},
                {"device", added ? "unknown: another renderer's" : context.context.device_name()},
                {"machine", machine_name()},
                {"program", program_name()}};
  if (takes_more_times(setting, light)) identity["times_at"] = setting.times_at;
  identity["key"] = hex(content_hash(identity.dump()));
  return identity;
}

void check_setting(const Setting& setting, const MeasureContext& context) {
  try {
    if (!context.renderers.contains(setting.renderer))
      throw Error(ExitCode::usage, "no command '" + setting.renderer + "' makes pictures");
    check_options(setting.renderer, setting.options);
  } catch (const Error& error) {
    throw Error(error.code(), fmt::format("{}: {}", setting.label(), error.what()));
  }
}

Json measure_point(const ReportScene& scene, const Setting& setting, const std::string& light,
                   const ReportReference& all_bounces, const ReportReference* one_bounce,
                   const MeasureContext& context) {
  Json point = point_identity(scene, setting, light, context);
  point["date"] = date_now();
  point["varied"] = setting.varied;
  point["one_bounce"] = setting.one_bounce;
  point["baseline"] = setting.baseline;
  point["light_arguments"] = scene.light_arguments;
  point["triangles"] = scene.scene.triangle_count();
  RenderTask task{scene.scene,     scene.camera,   context.size, light, frames_of(setting, context),
                  setting.options, context.context};
  point["command"] = command_of(scene, setting, task, context);
  point["reference"] = all_bounces.path.string();
  point["reference_command"] = all_bounces.command;
  point["compare"] = fmt::format("volgi compare {} point.exr --light {}", all_bounces.path.string(), light);
  try {
    const Rendering rendering = context.renderers.at(setting.renderer)(task);
    add_times(point, rendering);
    if (takes_more_times(setting, light)) {
      SceneOptions other;
      other.size_text = setting.times_at;
      task.size = other.size();
      const Rendering again = context.renderers.at(setting.renderer)(task);
      point["times_at"] = {
          {"size", {task.size.x, task.size.y}}, {"frame_ms", times_json(again)}, {"cpu_ms", again.cpu_ms}};
    }
    judge(point, rendering.picture, all_bounces, one_bounce);
    write_pictures(point, rendering.picture, all_bounces, context.folder);
  } catch (const Error& error) {
    if (error.code() == ExitCode::usage)
      throw Error(ExitCode::usage, fmt::format("{}: {}", setting.label(), error.what()));
    if (error.code() == ExitCode::cannot_write) throw;
    point["error"] = error.what();
  } catch (const std::bad_alloc&) {
    point["error"] = "out of memory";
  }
  return point;
}

std::string write_reference_picture(const ReportScene& scene, const std::string& light,
                                    const ReportReference& reference, const fs::path& folder) {
  fs::create_directories(folder / "pictures");
  std::string name = fmt::format("pictures/{}-{}.png", scene.name, light);
  write_png(folder / name, reference.file.color, exposure_of(reference));
  write_png_display(folder / fmt::format("pictures/{}-{}-radiance.png", scene.name, light),
                    radiance_bytes(reference.file.color));
  return name;
}

}  // namespace volgi::app
