#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <unordered_map>

#include "core/gltf/gltf_internal.h"

namespace volgi::gltf {
namespace {

using Json = nlohmann::json;

constexpr int deepest_nesting = 64;  // tinygltf recurses into "extras"

const std::set<std::string_view> supported_extensions = {
    "KHR_lights_punctual",        "KHR_materials_emissive_strength", "KHR_materials_ior",     "KHR_materials_specular",
    "KHR_materials_transmission", "KHR_texture_transform",           "KHR_mesh_quantization", "KHR_materials_unlit",
    "KHR_draco_mesh_compression", "EXT_meshopt_compression",         "EXT_texture_webp",      "EXT_mesh_gpu_instancing",
    "EXT_lights_image_based"};

/// Its specularFactor is not KHR_materials_specular's: read with checks of its own.
constexpr std::string_view SPECULAR_GLOSSINESS = "KHR_materials_pbrSpecularGlossiness";

/// Change how a surface looks, or what else a file says, but not where it is: ignored, and said, also where required.
const std::set<std::string_view> cosmetic_extensions = {
    "KHR_materials_variants",    "KHR_materials_clearcoat",  "KHR_materials_sheen",
    "KHR_materials_iridescence", "KHR_materials_anisotropy", "KHR_materials_dispersion",
    "KHR_materials_volume",      "KHR_xmp_json_ld",          "KHR_materials_diffuse_transmission"};

/// Textures of formats that are not read; the file may have others beside them.
constexpr std::string_view BASIS = "KHR_texture_basisu";

enum class Kind { index, index_or_object, indices, size, number, numbers, number_or_numbers, text, flag, object, list };

const std::unordered_map<std::string_view, Kind>& property_kinds() {
  static const std::unordered_map<std::string_view, Kind> kinds = [] {
    std::unordered_map<std::string_view, Kind> k;
    const auto add = [&k](Kind kind, std::initializer_list<std::string_view> names) {
      for (const auto name : names) k.emplace(name, kind);
    };
    add(Kind::index, {"bufferView", "buffer",  "material",  "mesh",      "camera",       "skin",
                      "source",     "sampler", "node",      "input",     "output",       "index",
                      "texCoord",   "light",   "scene",     "mode",      "skeleton",     "inverseBindMatrices",
                      "wrapS",      "wrapT",   "minFilter", "magFilter", "componentType"});
    add(Kind::index_or_object, {"indices"});
    add(Kind::indices, {"children", "joints", "attributes"});
    add(Kind::size, {"count", "byteOffset", "byteLength", "byteStride"});
    add(Kind::number,
        {"metallicFactor", "roughnessFactor", "specularFactor", "ior", "transmissionFactor", "alphaCutoff", "intensity",
         "range", "innerConeAngle", "outerConeAngle", "yfov", "znear", "zfar", "xmag", "ymag", "emissiveStrength"});
    add(Kind::numbers,
        {"translation", "matrix", "baseColorFactor", "emissiveFactor", "specularColorFactor", "color", "offset"});
    add(Kind::number_or_numbers, {"rotation", "scale"});
    add(Kind::text, {"uri", "name", "mimeType", "alphaMode", "type", "interpolation", "path"});
    add(Kind::flag, {"doubleSided", "normalized"});
    add(Kind::object,
        {"pbrMetallicRoughness", "baseColorTexture", "metallicRoughnessTexture", "emissiveTexture", "specularTexture",
         "specularColorTexture", "sparse", "values", "spot", "perspective", "orthographic", "extensions"});
    add(Kind::list, {"accessors", "animations", "buffers", "bufferViews", "cameras", "images", "materials", "meshes",
                     "nodes", "samplers", "scenes", "skins", "textures", "primitives", "channels", "lights"});
    return k;
  }();
  return kinds;
}

bool is_whole(const Json& value, std::uint64_t largest) {
  return value.is_number_unsigned() && value.get<std::uint64_t>() <= largest;
}

/// Whole numbers may be written 36.0 or 1e2 (glTF 2.0, 2.7: "should" not).
void make_whole(Json& value) {
  if (value.is_structured()) {
    for (Json& child : value) make_whole(child);
  } else if (value.is_number_float()) {
    constexpr double largest = 9007199254740992.0;  // 2^53
    const double number = value.get<double>();
    if (number >= 0.0 && number <= largest && number == std::floor(number)) value = std::uint64_t(number);
  }
}

bool is_index(const Json& value) { return is_whole(value, std::uint64_t(std::numeric_limits<int>::max())); }

template <typename Predicate>
bool all_of(const Json& value, Predicate predicate) {
  return std::all_of(value.begin(), value.end(), predicate);
}

bool is_numbers(const Json& value) {
  return value.is_array() && all_of(value, [](const Json& v) { return v.is_number(); });
}

/// What the property must be; nothing when it is.
const char* complaint(Kind kind, const Json& value) {
  switch (kind) {
    case Kind::index_or_object:
      if (value.is_object()) return nullptr;
      [[fallthrough]];
    case Kind::index:
      return is_index(value) ? nullptr : "a whole number from 0 to 2147483647";
    case Kind::indices:
      return value.is_structured() && all_of(value, is_index) ? nullptr : "made of whole numbers from 0 to 2147483647";
    case Kind::size:
      return is_whole(value, std::uint64_t(1) << 53) ? nullptr : "a whole number, zero or more";
    case Kind::number:
      return value.is_number() ? nullptr : "a number";
    case Kind::numbers:
      return is_numbers(value) ? nullptr : "a list of numbers";
    case Kind::number_or_numbers:
      return value.is_number() || is_numbers(value) ? nullptr : "a number or a list of numbers";
    case Kind::text:
      return value.is_string() ? nullptr : "a string";
    case Kind::flag:
      return value.is_boolean() ? nullptr : "true or false";
    case Kind::object:
      return value.is_object() ? nullptr : "an object";
    case Kind::list: {
      // "nodes" of a scene are indices, those of the file objects.
      const bool good =
          value.is_array() && (all_of(value, [](const Json& v) { return v.is_object(); }) || all_of(value, is_index));
      return good ? nullptr : "a list of objects";
    }
  }
  return nullptr;
}

bool is_of_whole_numbers(Kind kind) { return kind == Kind::index || kind == Kind::indices || kind == Kind::size; }

class PropertyCheck {
 public:
  explicit PropertyCheck(const std::filesystem::path& file) : file_(file) {}

  void walk(Json& value) {
    if (value.is_object()) {
      for (auto& [key, child] : value.items()) visit(key, child);
    } else if (value.is_array()) {
      for (size_t i = 0; i < value.size(); ++i) {
        if (!value[i].is_structured()) continue;
        trail_.push_back(fmt::format("[{}]", i));
        walk(value[i]);
        trail_.pop_back();
      }
    }
  }

 private:
  void visit(const std::string& key, Json& child) {
    if (key == "extras") return;
    trail_.push_back(trail_.empty() ? key : "." + key);
    const auto kind = property_kinds().find(key);
    if (kind != property_kinds().end() && is_of_whole_numbers(kind->second)) make_whole(child);
    const char* wrong = kind == property_kinds().end() ? nullptr : complaint(kind->second, child);
    if (wrong != nullptr) refuse(file_, fmt::format("{} must be {}", fmt::join(trail_, ""), wrong));
    if (key == "extensions") {
      for (auto& [name, extension] : child.items()) {
        // Meshopt's "mode" is a word; its numbers are checked where they are read.
        if (supported_extensions.contains(name) && name != "EXT_meshopt_compression") visit(name, extension);
      }
    } else {
      walk(child);
    }
    trail_.pop_back();
  }

  const std::filesystem::path& file_;
  std::vector<std::string> trail_;
};

void check_nesting(const std::filesystem::path& file, std::string_view text) {
  int depth = 0;
  bool in_string = false;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '{' || c == '[') {
      if (++depth > deepest_nesting) refuse(file, fmt::format("JSON nested deeper than {} levels", deepest_nesting));
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
}

void check_asset(const std::filesystem::path& file, const SceneReading& reading, Json& root) {
  const auto asset = root.find("asset");
  if (asset != root.end() && asset->is_object() && asset->contains("version") && (*asset)["version"].is_number()) {
    repair(file, reading, "asset.version is a number, not a string");
    (*asset)["version"] = fmt::format("{:.1f}", (*asset)["version"].get<double>());
  }
  if (asset == root.end() || !asset->is_object() || !asset->contains("version") || !(*asset)["version"].is_string()) {
    refuse(file, "not a glTF file: asset.version is missing");
  }
  const Json& least = asset->contains("minVersion") ? (*asset)["minVersion"] : (*asset)["version"];
  if (least.is_string() && least.get<std::string>() > "2.0" && asset->contains("minVersion"))
    refuse(file, fmt::format("needs glTF {}; 2.0 is supported", least.get<std::string>()));
  const auto version = (*asset)["version"].get<std::string>();
  if (!version.starts_with("2.")) {
    refuse(file,
           fmt::format("glTF version {} is not supported, only 2.0 is; Blender, or gltf-pipeline of npm, write it "
                       "as 2.0",
                       version));
  }
}

void check_extensions(const std::filesystem::path& file, const Json& root) {
  for (const char* list : {"extensionsRequired", "extensionsUsed"}) {
    const auto names = root.find(list);
    if (names == root.end()) continue;
    if (!names->is_array()) refuse(file, fmt::format("{} must be a list of strings", list));
    for (const Json& name : *names) {
      if (!name.is_string()) refuse(file, fmt::format("{} must be a list of strings", list));
      const auto text = name.get<std::string>();
      if (supported_extensions.contains(text) || text == SPECULAR_GLOSSINESS) continue;
      if (text == BASIS && list == std::string_view("extensionsRequired")) {
        refuse(file, fmt::format("requires {}: KTX2 textures are not read; export with PNG, JPEG or WebP", text));
      }
      if (!cosmetic_extensions.contains(text) && list == std::string_view("extensionsRequired")) {
        refuse(file, fmt::format("requires the extension {}, which is not supported; export without it", text));
      }
      warn(file, fmt::format("the extension {} is ignored", text));
    }
  }
}

/// Names that are null, as serializers write them.
void drop_null_names(const std::filesystem::path& file, const SceneReading& reading, Json& value) {
  if (value.is_array()) {
    for (Json& child : value) drop_null_names(file, reading, child);
  } else if (value.is_object()) {
    if (value.contains("name") && value["name"].is_null()) {
      repair(file, reading, "a name is null; it counts as none");
      value.erase("name");
    }
    for (auto& [key, child] : value.items()) {
      if (key != "extras" && key != "extensions") drop_null_names(file, reading, child);
    }
  }
}

/// tinygltf forgets all of pbrMetallicRoughness where baseColorFactor has not four numbers.
void complete_colors(const std::filesystem::path& file, const SceneReading& reading, Json& root) {
  const auto materials = root.find("materials");
  if (materials == root.end()) return;
  for (size_t i = 0; i < materials->size(); ++i) {
    Json& material = (*materials)[i];
    if (!material.contains("pbrMetallicRoughness")) continue;
    Json& pbr = material["pbrMetallicRoughness"];
    if (!pbr.contains("baseColorFactor") || pbr["baseColorFactor"].size() == 4) continue;
    const std::string who = fmt::format("materials[{}].pbrMetallicRoughness.baseColorFactor", i);
    if (pbr["baseColorFactor"].size() != 3) refuse(file, who + " must have four numbers");
    repair(file, reading, who + " has three numbers; alpha counts as 1");
    pbr["baseColorFactor"].push_back(1.0);
  }
}

}  // namespace

CheckedJson check_json(const std::filesystem::path& file, const SceneReading& reading, std::string_view text) {
  check_nesting(file, text);
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);  // a byte order mark
  Json root;
  try {
    root = Json::parse(text);
  } catch (const Json::exception& e) {
    refuse(file, fmt::format("not a glTF file: {}", e.what()));
  }
  if (!root.is_object()) refuse(file, "not a glTF file: the JSON is not an object");
  check_asset(file, reading, root);
  check_extensions(file, root);
  drop_null_names(file, reading, root);
  PropertyCheck(file).walk(root);
  complete_colors(file, reading, root);
  CheckedJson out;
  take_externals(file, reading, root, out);
  out.text = root.dump(-1, ' ', false, Json::error_handler_t::replace);
  return out;
}

}  // namespace volgi::gltf
