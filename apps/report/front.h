#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/volgi/front_file.h"
#include "core/gl/context.h"

namespace volgi::app {

/// The front of a report's points (`volgi report --sweep data/report/auto.json`), with each scene's facts.
/// Times of a software rasterizer are processor times, which other work on the machine does not change, times the part
/// of them that a picture takes by the clock: for each setting that of its quietest tenth.
/// @param data  folder of scenes.json. @throws Error(bad_input) where there is no point to use.
screen::MeasuredFront front_of_points(const std::vector<nlohmann::ordered_json>& points,
                                      const std::filesystem::path& data);

/// This device's times of settings of the front, on those of its scenes that are there (the Cornell box, which is
/// installed). Cost: about a minute.
DeviceTimes measure_device(const screen::MeasuredFront& front, const std::filesystem::path& scene,
                           gl::Context& context);

}  // namespace volgi::app
