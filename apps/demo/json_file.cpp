#include "apps/demo/json_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <glm/gtc/constants.hpp>
#include <iterator>
#include <system_error>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/one_line.h"

namespace volgi::demo {
namespace {

[[noreturn]] void bad(const std::string& file, const std::string& what) {
  throw Error(ExitCode::bad_input, fmt::format("{}: {}", file, one_line(what)));
}

std::string joined(const std::string& place, std::string_view key) {
  return place.empty() ? std::string(key) : fmt::format("{}.{}", place, key);
}

/// The place of a number that JSON has no text for; empty: there is none.
std::string not_finite(const Json& json, const std::string& place) {
  if (json.is_number_float()) return std::isfinite(json.get<double>()) ? std::string() : place;
  if (!json.is_structured()) return {};
  size_t index = 0;
  for (const auto& [key, member] : json.items()) {
    std::string found =
        not_finite(member, json.is_array() ? fmt::format("{}[{}]", place, index++) : joined(place, key));
    if (!found.empty()) return found;
  }
  return {};
}

}  // namespace

Json read_json(const std::filesystem::path& file) {
  std::error_code ignored;
  std::ifstream in(file, std::ios::binary);
  if (!in || std::filesystem::is_directory(file, ignored)) bad(file.string(), "no such file, or it cannot be read");
  const std::string text(std::istreambuf_iterator<char>(in), {});
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& e) {
    bad(file.string(), fmt::format("not JSON: wrong at byte {} of {}", e.byte, text.size()));
  } catch (const Json::exception&) {
    bad(file.string(), "a number is too large");
  }
}

void write_json(const std::filesystem::path& file, const Json& json) {
  const std::string place = not_finite(json, {});
  if (!place.empty())
    throw Error(ExitCode::cannot_write, fmt::format("cannot write {}: {} is not finite", file.string(), place));
  write_text_atomically(file, json.dump(2, ' ', false, Json::error_handler_t::ignore) + '\n');
}

JsonObject::JsonObject(const Json& json, std::string file, std::string place)
    : json_(json), file_(std::move(file)), place_(std::move(place)) {
  if (!json.is_object()) bad(file_, place_.empty() ? "must be an object" : place_ + ": must be an object");
}

const Json* JsonObject::find(std::string_view key) {
  known_.emplace_back(key);
  const auto found = json_.find(known_.back());
  return found == json_.end() ? nullptr : &*found;
}

const Json& JsonObject::need(std::string_view key) {
  const Json* found = find(key);
  if (found == nullptr) refuse(key, "is missing");
  return *found;
}

void JsonObject::read(std::string_view key, bool& value) {
  const Json* found = find(key);
  if (found == nullptr) return;
  if (!found->is_boolean()) refuse(key, "must be true or false");
  value = found->get<bool>();
}

void JsonObject::read(std::string_view key, std::string& value) {
  const Json* found = find(key);
  if (found == nullptr) return;
  if (!found->is_string()) refuse(key, "must be a text");
  value = found->get<std::string>();
}

void JsonObject::read(std::string_view key, int& value, int least, int most) {
  const Json* found = find(key);
  if (found == nullptr) return;
  const double number = found->is_number_integer() ? found->get<double>() : double(least) - 1.0;
  if (number < double(least) || number > double(most))
    refuse(key, fmt::format("must be a whole number from {} to {}", least, most));
  value = int(number);
}

void JsonObject::read(std::string_view key, double& value, double least, double most) {
  const Json* found = find(key);
  if (found == nullptr) return;
  const double number = found->is_number() ? found->get<double>() : std::nan("");
  if (!(number >= least && number <= most)) refuse(key, fmt::format("must be a number from {} to {}", least, most));
  value = number;
}

std::vector<double> JsonObject::numbers(std::string_view key, size_t count) {
  const Json& list = need(key);
  const auto is_number = [](const Json& v) { return v.is_number() && std::isfinite(v.get<double>()); };
  if (!list.is_array() || list.size() != count || !std::all_of(list.begin(), list.end(), is_number))
    refuse(key, fmt::format("must be a list of {} numbers", count));
  return list.get<std::vector<double>>();
}

std::string JsonObject::place_of(std::string_view key) const { return joined(place_, key); }

void JsonObject::refuse(std::string_view key, std::string_view what) const {
  bad(file_, fmt::format("{}: {}", place_of(key), what));
}

std::vector<std::string> JsonObject::unknown() const {
  std::vector<std::string> out;
  for (const auto& [key, member] : json_.items()) {
    if (std::find(known_.begin(), known_.end(), key) == known_.end()) out.push_back(place_of(key));
  }
  return out;
}

void check_version(JsonObject& file, std::string_view name, int newest, std::string_view what) {
  const Json* version = file.find(name);
  if (version == nullptr || !version->is_number_integer() || version->get<double>() < 1.0)
    bad(file.file(), fmt::format("not {}: \"{}\" must be its version, {}", what, name, newest));
  if (version->get<double>() > double(newest))
    bad(file.file(),
        fmt::format("{}: version {} is newer than this program, which reads {}", name, version->dump(), newest));
}

void put_pose(Json& json, const CameraPose& pose) {
  const glm::dquat& q = pose.orientation;
  json["position"] = {pose.position.x, pose.position.y, pose.position.z};
  json["orientation"] = {q.x, q.y, q.z, q.w};
  if (pose.ymag_m) {
    json["ymag_m"] = *pose.ymag_m;
    json.erase("yfov_rad");
  } else {
    json["yfov_rad"] = pose.yfov_rad;
    json.erase("ymag_m");
  }
}

CameraPose read_pose(JsonObject& object) {
  CameraPose pose;
  const std::vector<double> p = object.numbers("position", 3), q = object.numbers("orientation", 4);
  pose.position = {p[0], p[1], p[2]};
  pose.orientation = glm::dquat(q[3], q[0], q[1], q[2]);
  const double length = glm::length(pose.orientation);
  if (!(std::abs(length - 1.0) < 0.01)) object.refuse("orientation", "must be a quaternion x, y, z, w of length 1");
  // What this program wrote is kept to the bit.
  if (std::abs(length - 1.0) > 1e-12) pose.orientation /= length;
  constexpr double least = 1e-9, most_m = 1e12;
  if (object.find("ymag_m") != nullptr) {
    pose.ymag_m = 1.0;
    object.read("ymag_m", *pose.ymag_m, least, most_m);
    object.find("yfov_rad");
  } else {
    object.need("yfov_rad");
    object.read("yfov_rad", pose.yfov_rad, least, glm::pi<double>() - least);
  }
  return pose;
}

}  // namespace volgi::demo
