#include <fmt/format.h>

#include "apps/demo/camera_path.h"
#include "apps/demo/json_file.h"
#include "core/error.h"
#include "core/log.h"

namespace volgi::demo {
namespace {

constexpr const char* FORMAT = "volgi_camera_path";
constexpr int VERSION = 1;

void warn_of_unknown(const JsonObject& object) {
  for (const std::string& place : object.unknown())
    warn_once(fmt::format("{}: {}: unknown, ignored", object.file(), place));
}

CameraKey read_key(const Json& json, const std::string& file, size_t index) {
  JsonObject object(json, file, fmt::format("keys[{}]", index));
  constexpr double most_s = 1e9;
  CameraKey key;
  object.need("time_s");
  object.read("time_s", key.time_s, -most_s, most_s);
  key.pose = read_pose(object);
  key.scene_time_s = key.time_s;
  object.read("scene_time_s", key.scene_time_s, -most_s, most_s);
  warn_of_unknown(object);
  return key;
}

}  // namespace

CameraPath read_camera_path(const std::filesystem::path& file) {
  const Json json = read_json(file);
  JsonObject root(json, file.string());
  check_version(root, FORMAT, VERSION, "a camera path");
  const Json& list = root.need("keys");
  if (!list.is_array() || list.empty()) root.refuse("keys", "must be a list of one key or more");
  std::vector<CameraKey> keys;
  for (const Json& key : list) keys.push_back(read_key(key, file.string(), keys.size()));
  warn_of_unknown(root);
  try {
    return CameraPath(std::move(keys));
  } catch (const Error& e) {
    throw Error(e.code(), fmt::format("{}: {}", file.string(), e.what()));
  }
}

void write_camera_path(const std::filesystem::path& file, const CameraPath& path) {
  Json json;
  json[FORMAT] = VERSION;
  Json& keys = json["keys"] = Json::array();
  for (const CameraKey& key : path.keys()) {
    Json& out = keys.emplace_back();
    out["time_s"] = key.time_s;
    put_pose(out, key.pose);
    out["scene_time_s"] = key.scene_time_s;
  }
  write_json(file, json);
}

}  // namespace volgi::demo
