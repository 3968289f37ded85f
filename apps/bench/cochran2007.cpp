#include "apps/bench/cochran2007.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "apps/bench/repeated_frame.h"
#include "screen/gather/strided/virtual_light_gather.h"
#include "screen/lights/rsm/virtual_lights.h"
#include "screen/visibility/negative/negative_lights.h"

namespace volgi::app {

namespace {

/// Of the passes that make light of virtual lights.
double gather_ms(RepeatedFrame& picture) {
  return picture.passes_ms({screen::VirtualLightGather::name, screen::VirtualLightGather::discontinuity_name});
}

double coarse_share(const RepeatedFrame& picture) { return double(picture.frame().report().number("coarse_share")); }

/// Root mean square of the difference, in percent of the reference's largest value.
double rms_percent_of_range(const Image& reference, const Image& image) {
  double sum = 0.0, largest = 0.0;
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    const glm::dvec3 d = glm::dvec3(image.pixels[i]) - glm::dvec3(reference.pixels[i]);
    sum += glm::dot(d, d);
    const glm::vec3& r = reference.pixels[i];
    largest = std::max({largest, double(r.x), double(r.y), double(r.z)});
  }
  return largest > 0.0 ? 100.0 * std::sqrt(sum / (3.0 * double(image.pixels.size()))) / largest : 0.0;
}

screen::FrameOptions options_of(int vpls, int negative) {
  screen::FrameOptions o;
  o.size = {640, 480};
  o.recipe = negative > 0 ? "negative" : "vpl";
  o.of<screen::VirtualLightOptions>().count = vpls;
  o.of<screen::NegativeLightOptions>().count = std::max(negative, 1);
  o.of<screen::NegativeLightOptions>().method = screen::NegativeLightOptions::Method::cochran2007;
  return o;
}

struct LightsRow {
  int vpls, negative;
  double fps;  // the paper's, Quadro FX 5500
};
constexpr std::array<LightsRow, 6> kLights{
    {{100, 50, 26.5}, {150, 0, 32.6}, {200, 100, 15.6}, {300, 0, 19.2}, {300, 150, 11.0}, {450, 0, 13.6}}};

struct ShareRow {
  double share, rms_percent, fps;  // the paper's
};
constexpr std::array<ShareRow, 4> kShares{
    {{1.0, 1.5082, 42.5}, {0.875, 0.1688, 26.5}, {0.5, 0.0885, 15.4}, {0, 0, 12.6}}};

nlohmann::json lights_table(const Scene& scene, const gl::Context& context, int frames) {
  nlohmann::json rows = nlohmann::json::array();
  for (const LightsRow& row : kLights) {
    RepeatedFrame picture(scene, context, options_of(row.vpls, row.negative));
    picture.render_repeatedly(frames);
    rows.push_back({{"vpls", row.vpls},
                    {"negative", row.negative},
                    {"paper_fps", row.fps},
                    {"frame_ms", picture.frame_ms()},
                    {"gather_ms", gather_ms(picture)},
                    {"coarse_share", coarse_share(picture)}});
  }
  return rows;
}

/// The contrast that gives the paper's share, which grows with it. (Thresholds alone leave flat walls coarse.)
double contrast_for(const Scene& scene, const gl::Context& context, screen::FrameOptions options, double share) {
  double low = 0.0, high = 1.0;
  for (int i = 0; i < 12; ++i) {
    options.of<screen::GatherOptions>().contrast = float(0.5 * (low + high));
    RepeatedFrame picture(scene, context, options);
    picture.render();
    const double reached = coarse_share(picture);
    (reached < share ? low : high) = 0.5 * (low + high);
  }
  return high;
}

nlohmann::json share_table(const Scene& scene, const gl::Context& context, int frames) {
  screen::FrameOptions full = options_of(100, 50);
  full.light = screen::LightPart::indirect;
  full.of<screen::GatherOptions>().stride = 1;
  nlohmann::json rows = nlohmann::json::array();
  const auto add = [&](const std::string& what, const screen::FrameOptions& o, const ShareRow* paper) {
    RepeatedFrame every_pixel(scene, context, full), picture(scene, context, o);
    render_in_turn({&every_pixel, &picture}, frames);
    nlohmann::json row = {{"what", what},
                          {"coarse_share", coarse_share(picture)},
                          {"rms_percent", rms_percent_of_range(every_pixel.image(), picture.image())},
                          {"frame_ms", picture.frame_ms()},
                          {"gather_ms", gather_ms(picture)},
                          {"gather_speedup", gather_ms(every_pixel) / gather_ms(picture)}};
    if (paper != nullptr)
      row["paper"] = {{"share", paper->share}, {"rms_percent", paper->rms_percent}, {"fps", paper->fps}};
    rows.push_back(std::move(row));
  };
  for (const ShareRow& row : kShares) {
    screen::FrameOptions o = full;
    o.of<screen::GatherOptions>().stride = row.share > 0.0 ? 2 : 1;
    if (row.share == 1.0) o.of<screen::GatherOptions>() = {2, 10.0f, 1.0f, 1.0f};
    if (row.share > 0.0 && row.share < 1.0)
      o.of<screen::GatherOptions>().contrast = float(contrast_for(scene, context, o, row.share));
    add(row.share == 0.0   ? "every pixel"
        : row.share == 1.0 ? "coarse wherever there is something"
                           : fmt::format("contrast {:.3g}", o.of<screen::GatherOptions>().contrast),
        o, &row);
  }
  screen::FrameOptions defaults = full;
  defaults.of<screen::GatherOptions>() = {};
  add("defaults", defaults, nullptr);
  for (screen::FrameOptions* o : {&full, &defaults}) {
    o->of<screen::VirtualLightOptions>().count = 300;
    o->of<screen::NegativeLightOptions>().count = 150;
  }
  add("defaults, 300 and 150 lights", defaults, nullptr);
  return rows;
}

}  // namespace

nlohmann::json bench_cochran2007(const Scene& scene, const gl::Context& context, int frames) {
  return {{"scene", scene.name},
          {"triangles", scene.triangle_count()},
          {"device", context.device_name()},
          {"frames", frames},
          {"lights", lights_table(scene, context, frames)},
          {"shares", share_table(scene, context, frames)}};
}

std::string cochran2007_table(const nlohmann::json& results) {
  std::string text =
      fmt::format("{} ({} triangles), 640 x 480, {}; theirs: Quadro FX 5500\n", results["scene"].get<std::string>(),
                  results["triangles"].get<size_t>(), results["device"].get<std::string>());
  text += "  VPLs  negative   their fps   our frame    gather   coarse\n";
  for (const auto& r : results["lights"])
    text += fmt::format("  {:4}  {:8}   {:9.1f}  {:7.1f} ms {:6.1f} ms   {:4.1f} %\n", r["vpls"].get<int>(),
                        r["negative"].get<int>(), r["paper_fps"].get<double>(), r["frame_ms"].get<double>(),
                        r["gather_ms"].get<double>(), 100.0 * r["coarse_share"].get<double>());
  text += "  their share, RMS, fps       our share      RMS    gather   faster\n";
  for (const auto& r : results["shares"]) {
    std::string theirs;
    if (r.contains("paper"))
      theirs = fmt::format("{:5.1f} %  {:6.4f} %  {:4.1f}", 100.0 * r["paper"]["share"].get<double>(),
                           r["paper"]["rms_percent"].get<double>(), r["paper"]["fps"].get<double>());
    text += fmt::format("  {:<26} {:6.1f} %  {:6.4f} %  {:6.1f} ms  {:5.2f} x  ({})\n", theirs,
                        100.0 * r["coarse_share"].get<double>(), r["rms_percent"].get<double>(),
                        r["gather_ms"].get<double>(), r["gather_speedup"].get<double>(), r["what"].get<std::string>());
  }
  return text;
}

}  // namespace volgi::app
