#include "apps/report/report_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "apps/report/machine.h"
#include "core/error.h"
#include "core/log.h"
#include "core/one_line.h"
#include "reference/path_tracer.h"

namespace volgi::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// A name that is too long is none.
bool is_file(const fs::path& path) {
  std::error_code none;
  return fs::is_regular_file(path, none);
}

// Empty where there is no list: a scene is then a file.
Json listed_scenes(const fs::path& data) {
  std::ifstream file(data / "scenes.json");
  if (!file) return Json::array();
  Json list = Json::parse(file, nullptr, false);
  const auto refuse = [&](const std::string& what) {
    throw Error(ExitCode::bad_input, (data / "scenes.json").string() + ": " + what);
  };
  if (!list.is_array()) refuse("not a list of scenes");
  const auto is_text = [](const Json& object, const char* key, bool needed) {
    return object.contains(key) ? object[key].is_string() : !needed;
  };
  for (size_t k = 0; k < list.size(); ++k) {
    const Json& entry = list[k];
    if (!is_text(entry, "name", true) || !is_text(entry, "file", true))
      refuse(fmt::format("scene {} has no name or no file", k));
    for (const Json& of : {entry, entry.value("one_bounce", Json::object())}) {
      if (!of.is_object() || !is_text(of, "reference", false) || !is_text(of, "command", false))
        refuse(fmt::format("scene {}: a reference and its command are texts", k));
    }
  }
  return list;
}

// A listed file is relative to the data folder's parent; the build makes the large ones beside the program.
std::optional<fs::path> file_of(const Json& entry, const fs::path& data) {
  const fs::path listed = entry.at("file").get<std::string>();
  const fs::path root = data.has_parent_path() ? data.parent_path() : fs::path();
  const fs::path beside_program = fs::read_symlink("/proc/self/exe").parent_path().parent_path() / "data";
  for (const fs::path& path : {root / listed, data / listed.filename(),
                               beside_program.lexically_proximate(fs::current_path()) / listed.filename()}) {
    if (is_file(path)) return path;
  }
  return std::nullopt;
}

bool has_size(const fs::path& path, glm::ivec2 size) {
  if (!is_file(path)) return false;
  const Image picture = read_exr_rgb(path);
  return picture.width == size.x && picture.height == size.y;
}

std::optional<ReportScene::Stored> stored_reference(const Json& entry, const fs::path& data, glm::ivec2 size) {
  if (!entry.contains("reference") || !entry.contains("command")) return std::nullopt;
  const fs::path path = data.parent_path() / entry.at("reference").get<std::string>();
  if (!has_size(path, size)) return std::nullopt;
  return ReportScene::Stored{path, entry.at("command").get<std::string>()};
}

std::string names_of(const Json& list) {
  std::string names;
  for (const Json& entry : list) names += (names.empty() ? "" : ", ") + entry.at("name").get<std::string>();
  return names;
}

void use_listed_scene(ReportScene& scene, const Json& entry, const fs::path& data, glm::ivec2 size) {
  scene.all_bounces = stored_reference(entry, data, size);
  if (entry.contains("one_bounce")) scene.one_bounce = stored_reference(entry["one_bounce"], data, size);
}

PathTracerOptions tracer_options(const std::vector<std::string>& options, glm::ivec2 size) {
  PathTracerOptions tracer;
  tracer.size = size;
  for (size_t i = 0; i + 1 < options.size(); i += 2) {
    if (options[i] != "--spp")
      throw Error(ExitCode::bad_input, "references: '" + options[i] + "' is not --spp, the one option there is");
    tracer.samples_per_pixel = std::max(1, std::atoi(options[i + 1].c_str()));
  }
  return tracer;
}

ReportScene::Stored computed_reference(const ReportScene& scene, glm::ivec2 size,
                                       const std::vector<std::string>& options, const fs::path& folder) {
  const PathTracerOptions tracer = tracer_options(options, size);
  const std::string what = fmt::format("--size {}x{} --spp {}", size.x, size.y, tracer.samples_per_pixel);
  const fs::path path =
      folder / fmt::format("{}-{}-{}x{}-{}.exr", scene.name, scene.hash, size.x, size.y, tracer.samples_per_pixel);
  if (!is_file(path)) {
    fs::create_directories(folder);
    write_exr(path, to_channels(path_trace(scene.scene, scene.camera, tracer)));
  }
  return {path, fmt::format("volgi reference {}{} -o {} {}", scene.path.string(), scene.light_arguments, path.string(),
                            what)};
}

std::string hash_with(const std::string& scene, const AddedLight& added) {
  std::uint64_t hash = content_hash(added.arguments, content_hash(scene));
  for (const fs::path& file : added.files) hash = content_hash(hex(scene_hash(file)), hash);
  return hex(hash);
}

}  // namespace

ReportScene open_report_scene(const std::string& name_or_file, const fs::path& data, glm::ivec2 size,
                              const AddedLight& added) {
  const Json list = listed_scenes(data);
  ReportScene out;
  const Json* listed = nullptr;
  for (const Json& entry : list) {
    if (entry.at("name") != name_or_file && entry.at("name") != fs::path(name_or_file).stem().string()) continue;
    const std::optional<fs::path> path = file_of(entry, data);
    if (is_file(name_or_file)) {
      out.path = name_or_file;
      if (path && scene_hash(*path) == scene_hash(out.path)) listed = &entry;
    } else if (path) {
      out.path = *path;
      listed = &entry;
    } else {
      throw Error(ExitCode::bad_input, fmt::format("{}: {} is not there; the build makes it, or data/make_scenes.py",
                                                   name_or_file, one_line(entry.at("file").get<std::string>())));
    }
  }
  if (out.path.empty() && is_file(name_or_file)) out.path = name_or_file;
  if (out.path.empty())
    throw Error(ExitCode::bad_input, fmt::format("{}: neither a file nor one of the scenes in {}: {}", name_or_file,
                                                 (data / "scenes.json").string(), one_line(names_of(list))));
  out.name = out.path.stem().string();
  out.hash = hex(scene_hash(out.path));
  out.scene = load_scene(out.path);
  if (out.scene.cameras.empty()) warn_once(out.path.string() + ": no camera; the whole scene is framed");
  out.camera = out.scene.cameras.empty() ? framing_camera(out.scene.bounds_min, out.scene.bounds_max)
                                         : out.scene.cameras.front();
  if (!added.arguments.empty()) {
    added.apply(out.scene);
    out.light_arguments = added.arguments;
    out.hash = hash_with(out.hash, added);
  } else if (listed != nullptr) {
    use_listed_scene(out, *listed, data, size);
  }
  return out;
}

ReportReference reference_of(ReportScene& scene, const std::string& light, bool one_bounce, glm::ivec2 size,
                             const std::vector<std::string>& options, const fs::path& folder) {
  if (!one_bounce && !scene.all_bounces) scene.all_bounces = computed_reference(scene, size, options, folder);
  const ReportScene::Stored& from = one_bounce ? scene.one_bounce.value() : scene.all_bounces.value();
  using Light = PathTracerOptions::Light;
  ReportReference out{
      from.path, from.command, read_reference(from.path, light == "full" ? Light::full : Light::indirect), {}};
  out.mask = out.file.layers ? region_mask(Region::noedge, *out.file.layers) : Mask(out.file.color.pixels.size(), 1);
  return out;
}

}  // namespace volgi::app
