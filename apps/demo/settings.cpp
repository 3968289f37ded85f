#include "apps/demo/settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include "apps/demo/json_file.h"
#include "apps/demo/parameter_text.h"
#include "apps/demo/view.h"
#include "apps/volgi/volume_options.h"
#include "core/error.h"
#include "propagation/volume_options.h"
#include "screen/frame/registry.h"

namespace volgi::demo {
namespace {

namespace fs = std::filesystem;
using screen::Backend;
using screen::FrameOptions;
using screen::LightPart;
using screen::Parameter;

constexpr const char* FORMAT = "volgi_demo";
constexpr int VERSION = 1;
constexpr const char* AUTOMATIC = "auto";
constexpr int MOST_BOUNCES = 1000, MOST_ITERATIONS = 100000;  // of --bounces and --iterations
constexpr int MOST_FPS = 10000, MOST_FRAMES = 1'000'000, MOST_PIXELS = 16384;
constexpr double MOST_STOPS = 1000.0;

constexpr std::array LIGHTS{std::pair{"full", LightPart::full}, std::pair{"direct", LightPart::direct},
                            std::pair{"indirect", LightPart::indirect}};
constexpr std::array BACKENDS{std::pair{AUTOMATIC, Backend::automatic}, std::pair{"gpu", Backend::gpu},
                              std::pair{"cpu", Backend::cpu}};

// --- writing: into what was read, so that the rest stays ------------------------------------------------------------

Json& object_in(Json& json, const std::string& key) {
  Json& member = json[key];
  if (!member.is_object()) member = Json::object();
  return member;
}

template <class Table, class Value>
const char* name_in(const Table& table, Value value) {
  const auto* found = std::find_if(table.begin(), table.end(), [&](const auto& row) { return row.second == value; });
  return found->first;
}

template <class Value>
Json or_automatic(const std::optional<Value>& value) {
  return value ? Json(*value) : Json(AUTOMATIC);
}

void put_parameters(Json& json, const FrameOptions& options) {
  std::map<std::string, std::string> texts;
  for (const auto& [parameter, text] : parameters_set(options)) texts[parameter->name] = text;
  for (const Parameter* p : screen::parameters()) {
    const auto text = texts.find(p->name);
    if (text == texts.end()) {
      json.erase(p->name);
    } else {
      json[p->name] = text->second;
    }
  }
}

void put_volume(Json& json, const Settings& s) {
  const auto& volume = s.frame.of<VolumeOptions>();
  json["grid"] = s.grid_fits_scene ? Json(AUTOMATIC) : Json(volume.grid_cells);
  json["scheme"] = app::scheme_name(volume.scheme.scheme);
  json["directions"] = or_automatic(volume.scheme.directions);
  json["sh_order"] = volume.scheme.sh_order;
  json["iterations"] = or_automatic(volume.iterations);
}

void put_technique(Json& json, const Settings& s) {
  json["recipe"] = s.frame.recipe.empty() ? AUTOMATIC : s.frame.recipe;
  json["without"] = s.frame.without;
  json["backend"] = name_in(BACKENDS, s.frame.backend);
  json["light"] = name_in(LIGHTS, s.frame.light);
  json["bounces"] = s.frame.bounces ? Json(*s.frame.bounces) : Json("all");
  put_volume(object_in(json, "volume"), s);
  put_parameters(object_in(json, "parameters"), s.frame);
}

void put_picture(Json& json, const Settings& s) {
  json["view"] = s.view;
  json["exposure_ev"] = or_automatic(s.exposure_ev);
  json["post_filter"] = s.post_filter;
  json["progressive"] = s.progressive;
  json["most_samples"] = s.most_samples;
  json["motion_fps"] = s.motion_fps;
  json["reference"] = s.reference;
}

/// In the settings' order; what was there of the same name keeps its place's other members.
void put_bookmarks(Json& json, const std::vector<Bookmark>& bookmarks) {
  const Json before = std::exchange(json, Json::object());
  for (const Bookmark& bookmark : bookmarks) {
    Json& out = json[bookmark.name];
    out = before.contains(bookmark.name) ? before.at(bookmark.name) : Json::object();
    put_pose(out, bookmark.pose);
  }
}

void put_all_bookmarks(Json& json, const Settings& s) {
  std::vector<std::string> gone;
  for (const auto& [scene, list] : json.items())
    if (!s.bookmarks.contains(scene)) gone.push_back(scene);
  for (const std::string& scene : gone) json.erase(scene);
  for (const auto& [scene, list] : s.bookmarks) put_bookmarks(object_in(json, scene), list);
}

void put_window(Json& json, const Settings& s) {
  Json& fps = object_in(json, "fps_limits");
  fps["active"] = s.fps.active;
  fps["in_background"] = s.fps.in_background;
  Json& benchmark = object_in(json, "benchmark");
  benchmark["warm_up_frames"] = s.benchmark.warm_up_frames;
  benchmark["frames"] = s.benchmark.frames;
  benchmark["width"] = s.benchmark.width;
  benchmark["height"] = s.benchmark.height;
  Json& panels = object_in(json, "panels");
  for (const auto& [name, open] : s.panels) panels[name] = open;
  Json& recent = json["recent_files"] = Json::array();
  for (const fs::path& file : s.recent_files) recent.push_back(file.string());
}

// --- reading --------------------------------------------------------------------------------------------------------

/// What nobody read, said once the object is done with.
class Reader {
 public:
  explicit Reader(std::vector<std::string>& unknown) : unknown_(unknown) {}

  /// Reads the member `key` of `parent` by `read`, where there is one.
  template <class Read>
  void object(JsonObject& parent, const std::string& key, Read read) {
    const Json* json = parent.find(key);
    if (json == nullptr) return;
    JsonObject object(*json, parent.file(), parent.place_of(key));
    read(object);
    say_unknown(object);
  }
  void say_unknown(const JsonObject& object) {
    for (const std::string& place : object.unknown())
      unknown_.push_back(fmt::format("{}: {}: unknown to this version, kept", object.file(), place));
  }

 private:
  std::vector<std::string>& unknown_;
};

template <class Table, class Value>
void read_name(JsonObject& object, const char* key, const Table& table, Value& value) {
  std::string name = name_in(table, value);
  object.read(key, name);
  std::vector<std::string> known;
  for (const auto& [text, meaning] : table) {
    known.emplace_back(text);
    if (name != text) continue;
    value = meaning;
    return;
  }
  object.refuse(key, fmt::format("'{}' is none of {}", name, fmt::join(known, ", ")));
}

bool is_text(JsonObject& object, const char* key, std::string_view text) {
  const Json* found = object.find(key);
  return found != nullptr && found->is_string() && found->get<std::string>() == text;
}

/// A number, or the text that stands for none.
template <class Number>
void read_optional(JsonObject& object, const char* key, const char* none, std::optional<Number>& value, Number least,
                   Number most) {
  if (object.find(key) == nullptr) return;
  if (is_text(object, key, none)) {
    value.reset();
    return;
  }
  if (!object.find(key)->is_number()) object.refuse(key, fmt::format("must be a number or \"{}\"", none));
  Number number{};
  object.read(key, number, least, most);
  value = number;
}

/// Runs what refuses in words of the command line, and says it of the file.
template <class Do>
void in_words_of_file(const JsonObject& object, std::string_view key, Do run) {
  try {
    run();
  } catch (const Error& e) {
    object.refuse(key, e.what());
  }
}

void read_volume(JsonObject& object, Settings& s) {
  auto& volume = s.frame.of<VolumeOptions>();
  std::optional<int> grid;
  read_optional(object, "grid", AUTOMATIC, grid, 1, VolumeOptions::kMaxGridCells);
  s.grid_fits_scene = !grid;
  if (grid) volume.grid_cells = *grid;
  std::string scheme = app::scheme_name(volume.scheme.scheme);
  object.read("scheme", scheme);
  in_words_of_file(object, "scheme", [&] { volume.scheme.scheme = app::scheme_from_name(scheme); });
  read_optional(object, "directions", AUTOMATIC, volume.scheme.directions, 8, 128);
  const std::set<int> sets{8, 24, 48, 80, 128};
  if (volume.scheme.directions && !sets.contains(*volume.scheme.directions))
    object.refuse("directions", fmt::format("must be one of {}", fmt::join(sets, ", ")));
  object.read("sh_order", volume.scheme.sh_order, 1, 2);
  read_optional(object, "iterations", AUTOMATIC, volume.iterations, 1, MOST_ITERATIONS);
}

void read_parameters(JsonObject& object, FrameOptions& options) {
  for (const Parameter* p : screen::parameters()) {
    if (object.find(p->name) == nullptr) continue;
    std::string text;
    object.read(p->name, text);
    in_words_of_file(object, p->name,
                     [&] { p->set(options.settings, screen::parse_value(*p, text, "'" + text + "'")); });
  }
}

void read_without(JsonObject& object, std::vector<std::string>& without) {
  const Json* list = object.find("without");
  if (list == nullptr) return;
  const bool texts =
      list->is_array() && std::all_of(list->begin(), list->end(), [](const Json& j) { return j.is_string(); });
  if (!texts) object.refuse("without", "must be a list of stages' names");
  without = list->get<std::vector<std::string>>();
}

void read_technique(JsonObject& object, Settings& s, Reader& reader) {
  std::string recipe = AUTOMATIC;
  object.read("recipe", recipe);
  read_without(object, s.frame.without);
  // First, as what else the file says goes before what a recipe stands for.
  if (recipe != AUTOMATIC) in_words_of_file(object, "recipe", [&] { screen::apply_recipe(recipe, s.frame); });
  read_name(object, "backend", BACKENDS, s.frame.backend);
  read_name(object, "light", LIGHTS, s.frame.light);
  read_optional(object, "bounces", "all", s.frame.bounces, 0, MOST_BOUNCES);
  reader.object(object, "volume", [&](JsonObject& volume) { read_volume(volume, s); });
  reader.object(object, "parameters", [&](JsonObject& parameters) { read_parameters(parameters, s.frame); });
}

void read_picture(JsonObject& object, Settings& s) {
  object.read("view", s.view);
  in_words_of_file(object, "view", [&] { view_of(s.view); });
  read_optional(object, "exposure_ev", AUTOMATIC, s.exposure_ev, -MOST_STOPS, MOST_STOPS);
  object.read("post_filter", s.post_filter);
  object.read("progressive", s.progressive);
  object.read("most_samples", s.most_samples, 1, Settings::MOST_SAMPLES);
  object.read("motion_fps", s.motion_fps, 0.0, double(MOST_FPS));
  object.read("reference", s.reference);
}

void read_bookmarks(JsonObject& scene, const Json& json, std::vector<Bookmark>& bookmarks, Reader& reader) {
  for (const auto& [name, pose] : json.items()) {
    const auto read = [&, &of = name](JsonObject& object) { bookmarks.push_back({of, read_pose(object)}); };
    reader.object(scene, name, read);
  }
}

void read_all_bookmarks(JsonObject& object, const Json& json, Settings& s, Reader& reader) {
  for (const auto& [path, list] : json.items()) {
    std::vector<Bookmark>& bookmarks = s.bookmarks[path];
    reader.object(object, path,
                  [&, &scene_list = list](JsonObject& scene) { read_bookmarks(scene, scene_list, bookmarks, reader); });
  }
}

void read_recent_files(JsonObject& root, Settings& s) {
  const Json* list = root.find("recent_files");
  if (list == nullptr) return;
  if (!list->is_array() || !std::all_of(list->begin(), list->end(), [](const Json& v) { return v.is_string(); }))
    root.refuse("recent_files", "must be a list of texts");
  // The first of all is added last.
  for (auto file = list->rbegin(); file != list->rend(); ++file) add_recent_file(s, file->get<std::string>());
}

void read_window(JsonObject& root, Settings& s, Reader& reader) {
  reader.object(root, "fps_limits", [&](JsonObject& fps) {
    fps.read("active", s.fps.active, 0, MOST_FPS);
    fps.read("in_background", s.fps.in_background, 0, MOST_FPS);
  });
  reader.object(root, "benchmark", [&](JsonObject& benchmark) {
    benchmark.read("warm_up_frames", s.benchmark.warm_up_frames, 0, MOST_FRAMES);
    benchmark.read("frames", s.benchmark.frames, 1, MOST_FRAMES);
    benchmark.read("width", s.benchmark.width, 1, MOST_PIXELS);
    benchmark.read("height", s.benchmark.height, 1, MOST_PIXELS);
  });
  if (const Json* panels = root.find("panels"))
    reader.object(root, "panels", [&](JsonObject& object) {
      for (const auto& [name, open] : panels->items()) object.read(name, s.panels[name]);
    });
  if (const Json* bookmarks = root.find("bookmarks"))
    reader.object(root, "bookmarks", [&](JsonObject& object) { read_all_bookmarks(object, *bookmarks, s, reader); });
  read_recent_files(root, s);
}

}  // namespace

void add_recent_file(Settings& settings, const fs::path& file) {
  std::vector<fs::path>& files = settings.recent_files;
  std::erase(files, file);
  files.insert(files.begin(), file);
  if (files.size() > Settings::MOST_RECENT_FILES) files.resize(Settings::MOST_RECENT_FILES);
}

ReadSettings read_settings(const fs::path& file) {
  ReadSettings out;
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return out;
  const Json json = read_json(file);
  JsonObject root(json, file.string());
  check_version(root, FORMAT, VERSION, "settings of volgi-demo");
  Reader reader(out.unknown);
  Settings& s = out.settings;
  reader.object(root, "technique", [&](JsonObject& technique) { read_technique(technique, s, reader); });
  reader.object(root, "picture", [&](JsonObject& picture) { read_picture(picture, s); });
  read_window(root, s, reader);
  reader.say_unknown(root);
  s.as_read = json.dump();
  return out;
}

void write_settings(const fs::path& file, const Settings& s) {
  Json json = s.as_read.empty() ? Json::object() : Json::parse(s.as_read);
  json[FORMAT] = VERSION;
  put_technique(object_in(json, "technique"), s);
  put_picture(object_in(json, "picture"), s);
  put_window(json, s);
  put_all_bookmarks(object_in(json, "bookmarks"), s);
  std::error_code error;
  if (file.has_parent_path()) fs::create_directories(file.parent_path(), error);
  if (error)
    throw Error(ExitCode::cannot_write,
                fmt::format("{}: cannot make this folder: {}", file.parent_path().string(), error.message()));
  write_json(file, json);
}

fs::path default_settings_path() {
  const fs::path file = fs::path("volgi") / "demo.json";
  const char* folder = std::getenv("XDG_CONFIG_HOME");
  // A relative one is to be ignored (XDG Base Directory Specification).
  if (folder != nullptr && fs::path(folder).is_absolute()) return folder / file;
  const char* home = std::getenv("HOME");
  return home != nullptr && *home != '\0' ? fs::path(home) / ".config" / file : fs::path();
}

}  // namespace volgi::demo
