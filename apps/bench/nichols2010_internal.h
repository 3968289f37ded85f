#pragma once
// What the chapters of bench_nichols2010() share.
#include <fmt/format.h>

#include <initializer_list>
#include <string>

#include "apps/bench/nichols2010.h"
#include "apps/bench/repeated_frame.h"

namespace volgi::app::nichols2010 {

/// What all measurements are made with.
struct Bench {
  const std::function<Scene(const std::string&)>& scene_by_name;
  const gl::Context& context;
  const Nichols2010Options& options;
  const std::function<void(const std::string&)>& show;
};

/// A recipe with settings "NAME=VALUE", indirect light alone.
screen::FrameOptions settings(const char* recipe, int size, std::initializer_list<std::string> set);
inline std::string set(const char* name, double value) { return fmt::format("{}={:g}", name, value); }

/// bench.options.frames of each after one that warms up: a splatted frame takes seconds in software.
void render_in_turn(const Bench& bench, std::initializer_list<RepeatedFrame*> frames);

/// One picture, medians of bench.options.frames.
struct Timed {
  double frame_ms, indirect_ms;  // all; what makes indirect light, from mipmaps to upsampling
  double fragments;              // subsplats
  double patches;                // virtual lights that have light
};
Timed timed(const Bench& bench, const Scene& scene, const screen::FrameOptions& options);
Image picture(const Bench& bench, const Scene& scene, const screen::FrameOptions& options);

/// Root mean square difference in percent: of the reference's mean, and of its brightest value.
struct Rms {
  double of_mean, of_range;
};
Rms rms(const Image& reference, const Image& image);
nlohmann::json to_json(const Rms& r);
std::string text_of(const nlohmann::json& rms);

nlohmann::json chapter_3(const Bench& bench);
nlohmann::json chapter_4(const Bench& bench);

}  // namespace volgi::app::nichols2010
