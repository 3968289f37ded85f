#include "apps/volgi/front_file.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <numeric>

#include "apps/volgi/embedded_front.h"
#include "core/atomic_file.h"
#include "core/error.h"

namespace volgi::app {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int VERSION = 1;

Json number_or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

std::optional<double> optional_number(const Json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || found->is_null()) return std::nullopt;
  const double value = found->get<double>();
  if (!std::isfinite(value) || value < 0.0)
    throw std::runtime_error(fmt::format("{}: {} is no time or error", key, value));
  return value;
}

Json to_json(const screen::PictureFacts& f) {
  return {{"edge_m", f.scene.edge_m},
          {"cells", f.scene.cells},
          {"feature_m", f.scene.feature_m},
          {"flight_m", f.scene.flight_m},
          {"lit_area_m2", f.scene.lit_area_m2},
          {"lamps", f.scene.lamps},
          {"triangles", f.triangles},
          {"indirect_share", f.indirect_share},
          {"first_share", f.first_share},
          {"noise", f.noise},
          {"openness", f.openness},
          {"grid_cells", f.cells},
          {"shadow_texels", f.shadow_texels},
          {"emits", f.emits},
          {"sky", f.sky}};
}

screen::PictureFacts facts_of(const Json& json) {
  screen::PictureFacts f;
  json.at("edge_m").get_to(f.scene.edge_m);
  json.at("cells").get_to(f.scene.cells);
  json.at("feature_m").get_to(f.scene.feature_m);
  json.at("flight_m").get_to(f.scene.flight_m);
  json.at("lit_area_m2").get_to(f.scene.lit_area_m2);
  json.at("lamps").get_to(f.scene.lamps);
  json.at("triangles").get_to(f.triangles);
  json.at("indirect_share").get_to(f.indirect_share);
  json.at("first_share").get_to(f.first_share);
  json.at("noise").get_to(f.noise);
  json.at("openness").get_to(f.openness);
  json.at("grid_cells").get_to(f.cells);
  json.at("shadow_texels").get_to(f.shadow_texels);
  json.at("emits").get_to(f.emits);
  json.at("sky").get_to(f.sky);
  return f;
}

Json to_json(const screen::FrontPoint& p) {
  return {{"ms", number_or_null(p.ms)},
          {"large_ms", number_or_null(p.large_ms)},
          {"error_percent", number_or_null(p.error_percent)},
          {"indirect_error_percent", number_or_null(p.indirect_error_percent)}};
}

screen::FrontPoint point_of(const Json& json) {
  return {optional_number(json, "ms"), optional_number(json, "large_ms"), optional_number(json, "error_percent"),
          optional_number(json, "indirect_error_percent")};
}

screen::MeasuredFront front_of(const Json& json) {
  if (json.value("volgi_front", 0) != VERSION) throw std::runtime_error("not a front of this version");
  screen::MeasuredFront front;
  json.at("device").get_to(front.device);
  json.at("machine").get_to(front.machine);
  json.at("date").get_to(front.date);
  json.at("pixels").get_to(front.pixels);
  json.at("large_pixels").get_to(front.large_pixels);
  if (!(front.pixels > 0.0) || !(front.large_pixels > front.pixels)) throw std::runtime_error("sizes of times");
  for (const Json& s : json.at("settings"))
    front.settings.push_back({s.at("name").get<std::string>(), s.at("options").get<std::vector<std::string>>(),
                              s.at("pictures").get<int>()});
  for (const Json& s : json.at("scenes")) {
    screen::FrontScene scene{s.at("name").get<std::string>(), facts_of(s.at("facts")), {}};
    for (const Json& p : s.at("points")) scene.points.push_back(point_of(p));
    if (scene.points.size() != front.settings.size())
      throw std::runtime_error(
          fmt::format("{}: {} points for {} settings", scene.name, scene.points.size(), front.settings.size()));
    front.scenes.push_back(std::move(scene));
  }
  if (front.scenes.empty() || front.settings.empty()) throw std::runtime_error("it has no points");
  return front;
}

DeviceTimes device_times_of(const Json& json) {
  if (json.value("volgi_times", 0) != VERSION) throw std::runtime_error("not times of this version");
  DeviceTimes out;
  json.at("device").get_to(out.device);
  json.at("machine").get_to(out.machine);
  json.at("date").get_to(out.date);
  for (const Json& t : json.at("times")) {
    DeviceTimes::Time time{t.at("scene").get<std::string>(), t.at("setting").get<std::string>(),
                           t.at("ms").get<double>(), optional_number(t, "large_ms")};
    if (!(time.ms > 0.0) || (time.large_ms && !(*time.large_ms > 0.0)))
      throw std::runtime_error(time.setting + ": a time of nothing");
    out.times.push_back(std::move(time));
  }
  return out;
}

/// @throws Error(bad_input) for whatever goes wrong in `read`.
template <class Read>
auto parsed(std::string_view text, const std::string& name, const Read& read) {
  try {
    return read(Json::parse(text));
  } catch (const std::exception& error) {
    throw Error(ExitCode::bad_input, fmt::format("{}: {}; volgi calibrate writes it anew", name, error.what()));
  }
}

fs::path data_folder() {
  const char* folder = std::getenv("XDG_DATA_HOME");
  if (folder != nullptr && fs::path(folder).is_absolute()) return folder;
  const char* home = std::getenv("HOME");
  return home != nullptr && *home != '\0' ? fs::path(home) / ".local/share" : fs::path();
}

}  // namespace

const screen::MeasuredFront& shipped_front() {
  static const screen::MeasuredFront front = front_from_json(embedded_front("front.json"), "front.json");
  return front;
}

Json to_json(const screen::MeasuredFront& front) {
  Json json{{"volgi_front", VERSION},    {"device", front.device}, {"machine", front.machine},
            {"date", front.date},        {"pixels", front.pixels}, {"large_pixels", front.large_pixels},
            {"settings", Json::array()}, {"scenes", Json::array()}};
  for (const screen::FrontSetting& s : front.settings)
    json["settings"].push_back({{"name", s.name}, {"options", s.options}, {"pictures", s.pictures}});
  for (const screen::FrontScene& s : front.scenes) {
    Json points = Json::array();
    for (const screen::FrontPoint& p : s.points) points.push_back(to_json(p));
    json["scenes"].push_back({{"name", s.name}, {"facts", to_json(s.facts)}, {"points", std::move(points)}});
  }
  return json;
}

screen::MeasuredFront front_from_json(std::string_view text, const std::string& name) {
  return parsed(text, name, front_of);
}

fs::path device_times_path(const std::string& device) {
  const fs::path folder = data_folder();
  if (folder.empty()) return {};
  std::string name;
  for (const char c : device) name += std::isalnum(static_cast<unsigned char>(c)) ? c : '-';
  return folder / "volgi/times" / (name + ".json");
}

void write_device_times(const fs::path& file, const DeviceTimes& times) {
  Json json{{"volgi_times", VERSION},
            {"device", times.device},
            {"machine", times.machine},
            {"date", times.date},
            {"times", Json::array()}};
  for (const DeviceTimes::Time& t : times.times)
    json["times"].push_back(
        {{"scene", t.scene}, {"setting", t.setting}, {"ms", t.ms}, {"large_ms", number_or_null(t.large_ms)}});
  std::error_code error;
  if (file.has_parent_path()) fs::create_directories(file.parent_path(), error);
  write_text_atomically(file, json.dump(1) + '\n');
}

std::optional<DeviceTimes> read_device_times(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return std::nullopt;
  return parsed(std::string(std::istreambuf_iterator<char>(stream), {}), file.string(), device_times_of);
}

screen::DeviceFactors factors_of(const DeviceTimes& times, const screen::MeasuredFront& front) {
  screen::DeviceFactors factors{times.device, times.date, {}, {}};
  for (size_t s = 0; s < front.settings.size(); ++s) {
    std::vector<double> small, large;  // logarithms
    for (const DeviceTimes::Time& t : times.times) {
      if (t.setting != front.settings[s].name) continue;
      for (const screen::FrontScene& scene : front.scenes) {
        const screen::FrontPoint& p = scene.points[s];
        if (scene.name != t.scene || !p.ms) continue;
        small.push_back(std::log(t.ms / *p.ms));
        if (p.large_ms && t.large_ms) large.push_back(std::log(*t.large_ms / *p.large_ms));
      }
    }
    const auto mean = [](const std::vector<double>& logs) {
      return std::exp(std::accumulate(logs.begin(), logs.end(), 0.0) / double(std::max<size_t>(1, logs.size())));
    };
    factors.small.push_back(mean(small));
    factors.large.push_back(mean(large.empty() ? small : large));
  }
  return factors;
}

}  // namespace volgi::app
