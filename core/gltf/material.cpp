#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <limits>

#include "core/gltf/gltf_internal.h"

namespace volgi::gltf {
namespace {

float in_range(const Document& document, double value, double smallest, double largest, const std::string& who,
               std::string_view what) {
  const double nearest = std::clamp(value, smallest, largest);
  if (value != nearest) {
    repair(document, fmt::format("{}: {} is {}, outside {} ... {}; it counts as {}", who, what, value, smallest,
                                 largest, nearest));
  }
  return float(nearest);
}

glm::vec3 read_emission(const Document& document, const tinygltf::Material& in, const std::string& who) {
  constexpr double largest_factor = 1e6;  // glTF says 1; older exporters put the strength here
  constexpr double largest_strength = 1e12;
  glm::vec3 factor(0.0f);
  for (size_t c = 0; c < 3 && in.emissiveFactor.size() == 3; ++c) {
    factor[int(c)] = in_range(document, in.emissiveFactor[c], 0.0, largest_factor, who, "emissiveFactor");
  }
  const auto extension = in.extensions.find("KHR_materials_emissive_strength");
  if (extension == in.extensions.end() || !extension->second.Has("emissiveStrength")) return factor;
  const double strength = extension->second.Get("emissiveStrength").GetNumberAsDouble();
  return factor * in_range(document, strength, 0.0, largest_strength, who, "emissiveStrength");
}

/// The value of an extension's property, if the file has both.
const tinygltf::Value* find(const tinygltf::Material& in, const char* extension, const char* property) {
  const auto found = in.extensions.find(extension);
  return found != in.extensions.end() && found->second.Has(property) ? &found->second.Get(property) : nullptr;
}

void read_specular(const Document& document, const tinygltf::Material& in, const std::string& who, Material& material) {
  constexpr double largest_color = 1e6;  // the extension sets no limit
  constexpr const char* extension = "KHR_materials_specular";
  if (const tinygltf::Value* factor = find(in, extension, "specularFactor"))
    material.specular_factor = in_range(document, factor->GetNumberAsDouble(), 0.0, 1.0, who, "specularFactor");
  if (const tinygltf::Value* color = find(in, extension, "specularColorFactor")) {
    if (color->ArrayLen() != 3) refuse(document.path, fmt::format("{}: specularColorFactor needs three numbers", who));
    for (int c = 0; c < 3; ++c)
      material.specular_color_factor[c] =
          in_range(document, color->Get(c).GetNumberAsDouble(), 0.0, largest_color, who, "specularColorFactor");
  }
  for (const char* texture : {"specularTexture", "specularColorTexture"})
    if (find(in, extension, texture) != nullptr) warn(document.path, "specular textures are ignored");
}

void read_ior(const Document& document, const tinygltf::Material& in, const std::string& who, Material& material) {
  constexpr double largest_ior = 1e6;  // the extension sets no limit
  const tinygltf::Value* value = find(in, "KHR_materials_ior", "ior");
  if (value == nullptr) return;
  const double ior = value->GetNumberAsDouble();
  material.ior = ior == 0.0 ? 0.0f : in_range(document, ior, 1.0, largest_ior, who, "ior");
}

/// Of an extension that tinygltf does not know.
tinygltf::TextureInfo texture_info(const tinygltf::Value& value) {
  tinygltf::TextureInfo info;
  const auto whole = [&](const char* name, int otherwise) {
    if (!value.Has(name) || !value.Get(name).IsNumber()) return otherwise;
    const double number = value.Get(name).GetNumberAsDouble();
    return number >= 0.0 && number <= double(std::numeric_limits<int>::max()) ? int(number) : otherwise;
  };
  info.index = whole("index", -1);
  info.texCoord = whole("texCoord", 0);
  if (value.Has("extensions") && value.Get("extensions").Has("KHR_texture_transform"))
    info.extensions["KHR_texture_transform"] = value.Get("extensions").Get("KHR_texture_transform");
  return info;
}

/// KHR_materials_pbrSpecularGlossiness, archived: its colours instead of the metallic workflow's. Where a texture says
/// how much mirrors, what glTF's default does is taken.
void read_specular_glossiness(const Document& document, const tinygltf::Material& in, const std::string& who,
                              TextureTable& textures, Material& material) {
  constexpr const char* extension = "KHR_materials_pbrSpecularGlossiness";
  const auto found = in.extensions.find(extension);
  if (found == in.extensions.end()) return;
  warn(document.path, "KHR_materials_pbrSpecularGlossiness: taken as dielectric of its diffuse colour");
  const auto number = [&](const tinygltf::Value& value, const char* what) {
    if (!value.IsNumber()) refuse(document.path, fmt::format("{}: its {} is not a number", who, what));
    return in_range(document, value.GetNumberAsDouble(), 0.0, 1.0, who, what);
  };
  const auto numbers = [&](const char* name, int count, auto& into) {
    const tinygltf::Value* value = find(in, extension, name);
    if (value == nullptr) return;
    if (!value->IsArray() || value->ArrayLen() != size_t(count))
      refuse(document.path, fmt::format("{}: its {} needs {} numbers", who, name, count));
    for (int c = 0; c < count; ++c) into[c] = number(value->Get(c), name);
  };
  material.base_color_factor = glm::vec4(1.0f);
  numbers("diffuseFactor", 4, material.base_color_factor);
  material.base_color = {};
  if (const tinygltf::Value* texture = find(in, extension, "diffuseTexture")) {
    material.base_color = textures.use(texture_info(*texture), who + " diffuseTexture");
  }
  material.metallic_factor = 0.0f;
  material.metallic = {};
  const bool textured = find(in, extension, "specularGlossinessTexture") != nullptr;
  const tinygltf::Value* glossiness = find(in, extension, "glossinessFactor");
  material.roughness_factor = 1.0f - (glossiness != nullptr ? number(*glossiness, "glossinessFactor") : 1.0f);
  glm::vec3 mirror(1.0f);
  numbers("specularFactor", 3, mirror);
  constexpr float kOfDefault = 0.04f;
  material.specular_color_factor = textured ? glm::vec3(1.0f) : mirror / kOfDefault;
}

AlphaMode read_alpha_mode(const Document& document, const std::string& mode, const std::string& who) {
  if (mode == "OPAQUE" || mode.empty()) return AlphaMode::opaque;
  if (mode == "MASK") return AlphaMode::mask;
  if (mode == "BLEND") return AlphaMode::blend;
  std::string upper = mode;
  std::transform(upper.begin(), upper.end(), upper.begin(), [](unsigned char c) { return char(std::toupper(c)); });
  const bool known = upper != mode && (upper == "OPAQUE" || upper == "MASK" || upper == "BLEND");
  if (!known) refuse(document.path, fmt::format("{} has the unknown alphaMode '{}'", who, mode));
  repair(document, fmt::format("{}: its alphaMode '{}' counts as {}", who, mode, upper));
  return read_alpha_mode(document, upper, who);
}

Material read_material(const Document& document, size_t index, TextureTable& textures) {
  const tinygltf::Material& in = document.model.materials[index];
  const tinygltf::PbrMetallicRoughness& pbr = in.pbrMetallicRoughness;
  const std::string who = element("material", index, in.name);
  Material material;
  material.name = in.name;
  for (size_t c = 0; c < 4 && pbr.baseColorFactor.size() == 4; ++c) {
    material.base_color_factor[int(c)] = in_range(document, pbr.baseColorFactor[c], 0.0, 1.0, who, "baseColorFactor");
  }
  material.base_color = textures.use(pbr.baseColorTexture, who + " baseColorTexture");
  material.metallic_factor = in_range(document, pbr.metallicFactor, 0.0, 1.0, who, "metallicFactor");
  material.roughness_factor = in_range(document, pbr.roughnessFactor, 0.0, 1.0, who, "roughnessFactor");
  material.metallic = textures.use(pbr.metallicRoughnessTexture, who + " metallicRoughnessTexture");
  material.specular_factor = 1.0f;
  read_specular(document, in, who, material);
  read_ior(document, in, who, material);
  read_specular_glossiness(document, in, who, textures, material);
  material.emissive_radiance = read_emission(document, in, who);
  material.emissive = textures.use(in.emissiveTexture, who + " emissiveTexture");
  material.alpha_mode = read_alpha_mode(document, in.alphaMode, who);
  material.alpha_cutoff = in_range(document, in.alphaCutoff, 0.0, 1e6, who, "alphaCutoff");
  apply_transmission(document, in, who, textures, material);
  material.double_sided = in.doubleSided;
  tinygltf::TextureInfo normal;
  normal.index = in.normalTexture.index;
  normal.texCoord = in.normalTexture.texCoord;
  normal.extensions = in.normalTexture.extensions;
  material.normal = textures.use(normal, who + " normalTexture");
  material.normal_scale = in_range(document, in.normalTexture.scale, -1e3, 1e3, who, "normalTexture's scale");
  material.unlit = in.extensions.contains("KHR_materials_unlit");
  if (material.unlit) material.emissive_radiance = glm::vec3(0.0f);
  return material;
}

/// Which two sets of texture coordinates a material's textures use; their places among the two become the textures'.
std::array<int, 2> take_uv_sets(const Document& document, const std::string& who, Material& material) {
  const std::array<TextureUse*, 4> uses{&material.base_color, &material.metallic, &material.emissive, &material.normal};
  std::set<int> sets;
  for (const TextureUse* use : uses) {
    if (use->texture >= 0) sets.insert(use->texcoord);
  }
  if (sets.empty() || *sets.rbegin() <= 1) return {0, 1};
  std::array<int, 2> taken{*sets.begin(), *sets.begin()};
  if (sets.size() > 1) taken[1] = *std::next(sets.begin());
  if (sets.size() > 2)
    warn(document.path,
         fmt::format("{} uses {} sets of texture coordinates; the first two are read", who, sets.size()));
  for (TextureUse* use : uses) use->texcoord = use->texcoord == taken[0] ? 0 : use->texcoord == taken[1] ? 1 : 0;
  return taken;
}

bool needs_default_material(const Document& document) {
  for (const tinygltf::Mesh& mesh : document.model.meshes) {
    for (const tinygltf::Primitive& primitive : mesh.primitives) {
      if (primitive.material < 0) return true;
    }
  }
  return false;
}

void warn_of_metals(const Document& document, const std::vector<Material>& materials) {
  const auto is_metal = [](const Material& m) {
    const bool colored = glm::vec3(m.base_color_factor) != glm::vec3(0.0f);
    return m.metallic_factor >= 1.0f && m.metallic.texture < 0 && colored;
  };
  const auto metal = std::find_if(materials.begin(), materials.end(), is_metal);
  if (metal == materials.end()) return;
  const size_t index = size_t(metal - materials.begin());
  const bool in_file = index < document.model.materials.size();
  const std::string who = in_file ? element("material", index, metal->name) : "glTF's default material";
  warn(document.path, fmt::format("{} is a metal (metallicFactor 1, glTF's default): what it reflects on "
                                  "other surfaces is spread as if it were diffuse",
                                  who));
}

}  // namespace

Materials read_materials(const Document& document) {
  Materials out;
  TextureTable textures(document, out);
  for (size_t i = 0; i < document.model.materials.size(); ++i) {
    Material& material = out.materials.emplace_back(read_material(document, i, textures));
    out.uv_sets.push_back(take_uv_sets(document, element("material", i, material.name), material));
  }
  textures.decode();
  if (needs_default_material(document)) {
    Material& of_gltf = out.materials.emplace_back();
    of_gltf.name = "default";
    of_gltf.specular_factor = 1.0f;
  }
  warn_of_metals(document, out.materials);
  if (out.materials.empty()) out.materials.emplace_back().name = "default";
  out.uv_sets.resize(out.materials.size(), {0, 1});
  return out;
}

}  // namespace volgi::gltf
