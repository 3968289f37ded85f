#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "screen/frame/choice.h"

namespace volgi::app {

/// The front that is part of the program (data/report/front.json).
const screen::MeasuredFront& shipped_front();

nlohmann::ordered_json to_json(const screen::MeasuredFront& front);
/// @param name  of the file, for messages. @throws Error(bad_input) naming what is wrong.
screen::MeasuredFront front_from_json(std::string_view text, const std::string& name);

/// Times of a device, as `volgi calibrate` keeps them.
struct DeviceTimes {
  std::string device, machine, date;
  struct Time {
    std::string scene, setting;
    double ms = 0.0;
    std::optional<double> large_ms = {};  // none: the setting is measured at one size
  };
  std::vector<Time> times;
};
/// Where they are kept: $XDG_DATA_HOME/volgi/times/DEVICE.json; empty where there is no such folder.
std::filesystem::path device_times_path(const std::string& device);
void write_device_times(const std::filesystem::path& file, const DeviceTimes& times);
/// None where there is no such file. @throws Error(bad_input) for a file that is something else.
std::optional<DeviceTimes> read_device_times(const std::filesystem::path& file);
/// How much longer a device takes than the front's, by what both have measured.
screen::DeviceFactors factors_of(const DeviceTimes& times, const screen::MeasuredFront& front);

}  // namespace volgi::app
