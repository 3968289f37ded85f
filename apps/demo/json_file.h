#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "apps/demo/camera_pose.h"

namespace volgi::demo {

/// Members keep their order.
using Json = nlohmann::ordered_json;

/// @throws Error(bad_input) naming the file: not there, or no JSON (at which byte).
Json read_json(const std::filesystem::path& file);
/// Indented by two, atomically; text that is no UTF-8 loses the bytes that are not.
/// @throws Error(cannot_write) naming the file, and the member where a number is not finite.
void write_json(const std::filesystem::path& file, const Json& json);

/// An object of a file, read member by member with checks that name file and member; what nobody reads is unknown.
class JsonObject {
 public:
  /// @param place  of the object in the file: "keys[3]"; empty: the file itself.
  /// @throws Error(bad_input) where `json` is no object.
  JsonObject(const Json& json, std::string file, std::string place = {});

  /// Null where there is no such member, which is then known all the same.
  const Json* find(std::string_view key);
  /// @throws Error(bad_input) where there is no such member.
  const Json& need(std::string_view key);

  /// These leave `value` alone where there is no such member.
  /// @throws Error(bad_input) for another type, or a number outside of the range.
  void read(std::string_view key, bool& value);
  void read(std::string_view key, std::string& value);
  void read(std::string_view key, int& value, int least, int most);
  void read(std::string_view key, double& value, double least, double most);

  /// Numbers of a list. @throws Error(bad_input) unless there are `count` of them, finite.
  std::vector<double> numbers(std::string_view key, size_t count);

  /// Place of a member: "keys[3].position".
  std::string place_of(std::string_view key) const;
  const std::string& file() const { return file_; }
  /// @throws Error(bad_input): FILE: PLACE.KEY: WHAT.
  [[noreturn]] void refuse(std::string_view key, std::string_view what) const;
  /// Places of the members that nobody asked for, in the file's order.
  std::vector<std::string> unknown() const;

 private:
  const Json& json_;
  std::string file_, place_;
  std::vector<std::string> known_;
};

/// The file's format and version: the member `name`, a whole number.
/// @param newest  the version that this program writes; older ones from 1 are read.
/// @throws Error(bad_input) where it is missing ("not a WHAT"), or newer.
void check_version(JsonObject& file, std::string_view name, int newest, std::string_view what);

/// "position" [x,y,z], "orientation" [x,y,z,w], and "yfov_rad" or "ymag_m".
void put_pose(Json& json, const CameraPose& pose);
/// @throws Error(bad_input) naming what is missing, not finite, or out of range; an orientation that is not of unit
/// length to 1 %.
CameraPose read_pose(JsonObject& object);

}  // namespace volgi::demo
