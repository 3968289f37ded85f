#include "apps/bench/yardstick.h"

#include <fmt/format.h>

#include <type_traits>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/image.h"

namespace volgi::app {

namespace {

/// FNV-1a over values, never over padding.
class Hash {
 public:
  template <typename T>
  void add(const T& value) {
    static_assert(std::has_unique_object_representations_v<T> || std::is_floating_point_v<T>);
    add_bytes(&value, sizeof value);
  }
  template <glm::length_t N, typename T, glm::qualifier Q>
  void add(const glm::vec<N, T, Q>& v) {
    static_assert(sizeof v == N * sizeof(T));
    add_bytes(&v, sizeof v);
  }
  void add(const glm::mat3& m) { add_bytes(&m, sizeof m); }
  void add(const glm::mat4& m) { add_bytes(&m, sizeof m); }
  template <typename T>
  void add(const std::vector<T>& values) {
    add(values.size());
    if constexpr (std::is_same_v<T, std::uint8_t>) {
      add_bytes(values.data(), values.size());
    } else {
      for (const T& value : values) add(value);
    }
  }
  void add(const TextureUse& use) {
    add(use.texture);
    add(use.texcoord);
    add(use.uv_from_texcoord);
  }
  std::uint64_t value() const { return value_; }

 private:
  void add_bytes(const void* data, size_t count) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (size_t i = 0; i < count; ++i) value_ = (value_ ^ bytes[i]) * 0x100000001b3ull;
  }
  std::uint64_t value_ = 0xcbf29ce484222325ull;
};

void add(Hash& hash, const Mesh& mesh) {
  hash.add(mesh.material);
  hash.add(mesh.object_id);
  hash.add(mesh.positions);
  hash.add(mesh.normals);
  for (const auto& uv : mesh.uv) hash.add(uv);
  hash.add(mesh.colors);
  hash.add(mesh.triangles);
}

void add(Hash& hash, const Material& material) {
  hash.add(material.base_color_factor);
  hash.add(material.base_color);
  hash.add(material.metallic_factor);
  hash.add(material.roughness_factor);
  hash.add(material.metallic);
  hash.add(material.specular_factor);
  hash.add(material.specular_color_factor);
  hash.add(material.ior);
  hash.add(material.emissive_radiance);
  hash.add(material.emissive);
  hash.add(material.alpha_mode);
  hash.add(material.alpha_cutoff);
  hash.add(material.double_sided);
}

void add(Hash& hash, const Texture& texture) {
  hash.add(texture.image);
  hash.add(texture.sampler.wrap_s);
  hash.add(texture.sampler.wrap_t);
  hash.add(texture.sampler.magnify_nearest);
  hash.add(texture.sampler.minify_nearest);
  hash.add(texture.sampler.mipmap);
  hash.add(texture.sampler.mipmap_nearest);
}

void add(Hash& hash, const TextureImage& image) {
  hash.add(image.width);
  hash.add(image.height);
  hash.add(image.rgba.bytes());
}

void add(Hash& hash, const Light& light) {
  hash.add(light.type);
  hash.add(light.position);
  hash.add(light.direction);
  hash.add(light.intensity);
  hash.add(light.inner_cone_rad);
  hash.add(light.outer_cone_rad);
  hash.add(light.range_m);
}

void add(Hash& hash, const Camera& camera) {
  hash.add(camera.kind);
  hash.add(camera.yfov_rad);
  hash.add(camera.ymag);
  hash.add(camera.znear);
  hash.add(camera.zfar);
  hash.add(camera.world_from_camera);
}

std::uint64_t content_hash(const Scene& scene, const Camera& camera) {
  Hash hash;
  hash.add(scene.world_origin);
  const auto all = [&](const auto& parts) {
    hash.add(parts.size());
    for (const auto& part : parts) add(hash, part);
  };
  all(scene.meshes);
  all(scene.materials);
  all(scene.textures);
  all(scene.images);
  all(scene.lights);
  add(hash, camera);
  return hash.value();
}

std::filesystem::path file_in(const std::filesystem::path& folder, const Scene& scene, const Camera& camera,
                              const PathTracerOptions& o) {
  const std::string bounces = o.max_bounces ? fmt::format("{}", *o.max_bounces) : "all";
  return folder / fmt::format("{}_{:016x}_{}x{}_{}spp_seed{}_{}.exr", scene.name, content_hash(scene, camera), o.size.x,
                              o.size.y, o.samples_per_pixel, o.seed, bounces);
}

}  // namespace

Yardstick::Yardstick(ReferenceFile reference, const std::string& name) : reference_(std::move(reference)) {
  if (!reference_.layers)
    throw Error(ExitCode::bad_input, name + ": no position, normal, id and direct layers: trace it anew");
  mask_ = region_mask(Region::noedge, *reference_.layers);
  const Metrics m = volgi::measure(reference_.color, reference_.color, nullptr, mask_);
  if (m.pixels == 0 || !m.relative)
    throw Error(ExitCode::bad_input, name + ": no indirect light to compare with: take another scene or more pixels");
}

double Yardstick::noise_percent() const {
  if (!reference_.noise) return 0.0;
  Image noisy = reference_.color;
  for (size_t i = 0; i < noisy.pixels.size(); ++i) noisy.pixels[i] += reference_.noise->pixels[i];
  return volgi::measure(reference_.color, noisy, nullptr, mask_).relative->rmse_pct;
}

Metrics::Relative Yardstick::measure(const Image& image) const {
  return *volgi::measure(reference_.color, image, reference_.noise ? &*reference_.noise : nullptr, mask_).relative;
}

double Yardstick::error_percent(const Image& image) const {
  const Metrics::Relative error = measure(image);
  return error.rmse_pct_denoised.value_or(error.rmse_pct);
}

ReferenceFile cached_reference(const Scene& scene, const Camera& camera, PathTracerOptions options,
                               const std::filesystem::path& folder) {
  options.light = PathTracerOptions::Light::indirect;
  const std::filesystem::path file = file_in(folder, scene, camera, options);
  if (!std::filesystem::exists(file)) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw Error(ExitCode::cannot_write, folder.string() + ": cannot make this folder: " + error.message());
    check_writable(file);  // not after minutes of tracing
    write_exr(file, to_channels(path_trace(scene, camera, options)));
  }
  return read_reference(file, PathTracerOptions::Light::indirect);
}

}  // namespace volgi::app
