#include "screen/bounces/volume/contacts.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/constants.hpp>

#include "core/hash.h"
#include "core/level.h"
#include "core/octahedral.h"
#include "propagation/light_in/contact_light_cpu.h"

namespace volgi::screen {
namespace {

// Of the mean: near light from which on sides are too coarse. From 2 to 4 it is all one; at 1, corners count as well.
constexpr float BRIGHT = 3.0f;
constexpr int REACH = 3;  // cells that a side shows in: of a mean over 3^3 read between two

std::vector<glm::vec4> download(const gl::Texture& texture) {
  const std::vector<float> values = texture.download(4);
  std::vector<glm::vec4> texels(values.size() / 4);
  std::memcpy(texels.data(), values.data(), texels.size() * sizeof(glm::vec4));
  return texels;
}

glm::vec3 geometric_normal(glm::vec4 texel) { return octahedral_decode(glm::vec2(texel.z, texel.w)); }

template <class Visit>
void for_cells_around(const Grid& grid, glm::ivec3 centre, const Visit& visit) {
  const glm::ivec3 low = glm::max(centre - REACH, 0), high = glm::min(centre + REACH, grid.cells - 1);
  for (int z = low.z; z <= high.z; ++z) {
    for (int y = low.y; y <= high.y; ++y) {
      for (int x = low.x; x <= high.x; ++x) visit(glm::ivec3(x, y, z));
    }
  }
}

/// Which cells have a side around them with so much near light; empty: none.
std::vector<bool> cells_at_contacts(const VoxelGrid& voxels, const std::vector<float>& near, float least) {
  std::vector<bool> cells;
  for (size_t s = 0; s < near.size(); ++s) {
    if (near[s] < least) continue;
    cells.resize(cell_count(voxels.grid()), false);
    for_cells_around(voxels.grid(), shared::cell_coord(voxels.grid(), voxels.sides()[s].cell),
                     [&](glm::ivec3 c) { cells[size_t(shared::cell_index(voxels.grid(), c))] = true; });
  }
  return cells;
}

/// Near light of the brightest side around that looks the same way.
float near_light_at(const VoxelGrid& voxels, const std::vector<float>& near, glm::ivec3 cell, glm::vec3 normal) {
  float most = 0.0f;
  for_cells_around(voxels.grid(), cell, [&](glm::ivec3 c) {
    const glm::uvec2 own = voxels.cell_sides(c);
    const size_t last = own.x + shared::count_bits(own.y & 63u);
    for (size_t s = own.x; s < last; ++s) {
      if (near[s] > most && glm::dot(voxels.sides()[s].normal, normal) > SIMILAR_NORMAL_COSINE) most = near[s];
    }
  });
  return most;
}

struct Pixel {
  size_t index;
  float near;  // light
};

/// The `most` pixels with the most near light of those that have `least`, in their order.
std::vector<Pixel> pixels_at_contacts(const VoxelGrid& voxels, const std::vector<float>& near, float least,
                                      std::span<const glm::vec4> positions, std::span<const glm::vec4> normals,
                                      size_t most) {
  const Grid& grid = voxels.grid();
  const std::vector<bool> cells = cells_at_contacts(voxels, near, least);
  std::vector<float> of_pixel(cells.empty() ? 0 : positions.size(), 0.0f);
  tbb::parallel_for(size_t(0), of_pixel.size(), [&](size_t i) {
    if (positions[i].w == 0.0f) return;
    const glm::vec3 normal = geometric_normal(normals[i]);
    const glm::vec3 before = shared::cell_from_world(grid, glm::vec3(positions[i])) + 0.25f * normal;
    const glm::ivec3 cell(glm::clamp(before, glm::vec3(0.0f), glm::vec3(grid.cells - 1)));
    if (cells[size_t(shared::cell_index(grid, cell))]) of_pixel[i] = near_light_at(voxels, near, cell, normal);
  });
  std::vector<Pixel> pixels;
  for (size_t i = 0; i < of_pixel.size(); ++i) {
    if (of_pixel[i] >= least) pixels.push_back({i, of_pixel[i]});
  }
  if (pixels.size() <= most) return pixels;
  const auto brighter = [](const Pixel& a, const Pixel& b) {
    return a.near > b.near || (a.near == b.near && a.index < b.index);
  };
  std::nth_element(pixels.begin(), pixels.begin() + std::ptrdiff_t(most), pixels.end(), brighter);
  pixels.resize(most);
  std::sort(pixels.begin(), pixels.end(), [](const Pixel& a, const Pixel& b) { return a.index < b.index; });
  return pixels;
}

std::vector<ContactPoint> points_of(std::span<const Pixel> pixels, const ContactPicture& picture,
                                    std::span<const glm::vec4> positions, std::span<const glm::vec4> normals) {
  const bool perspective = picture.camera.kind == Camera::Kind::perspective;
  const glm::vec3 eye(picture.camera.world_from_camera[3]), back(picture.camera.world_from_camera[2]);
  const std::uint32_t sample = hash(std::uint32_t(picture.sample));
  std::vector<ContactPoint> points;
  for (const Pixel& p : pixels) {
    const glm::vec3 position(positions[p.index]);
    const glm::vec3 way = perspective ? position - eye : -back;
    points.push_back({position, geometric_normal(normals[p.index]), glm::normalize(way),
                      perspective ? glm::length(way) : std::numeric_limits<float>::infinity(),
                      std::uint32_t(p.index) ^ sample});
  }
  return points;
}

/// What comes from afar changes little over a part of a cell: means over pixels around, by a Gaussian in space.
std::vector<ContactPart> evened(std::span<const Pixel> pixels, std::span<const ContactPoint> points,
                                std::span<const ContactLight> lights, glm::ivec2 size, float cell_m) {
  constexpr float WIDTH = 0.3f;  // cells; with 0.5 room has 3.8 % for 3.3, without 3.9
  constexpr int WINDOW = 5;      // pixels
  constexpr float ALIKE = 0.9f;  // cosine of normals
  std::vector<int> numbers(size_t(size.x) * size_t(size.y), -1);
  for (size_t k = 0; k < pixels.size(); ++k) numbers[pixels[k].index] = int(k);
  std::vector<ContactPart> means(points.size());
  tbb::parallel_for(size_t(0), points.size(), [&](size_t k) {
    const glm::ivec2 at(int(pixels[k].index % size_t(size.x)), int(pixels[k].index / size_t(size.x)));
    const glm::ivec2 low = glm::max(at - WINDOW, 0), high = glm::min(at + WINDOW, size - 1);
    float weights = 0.0f;
    for (int y = low.y; y <= high.y; ++y) {
      for (int x = low.x; x <= high.x; ++x) {
        const int n = numbers[size_t(y) * size_t(size.x) + size_t(x)];
        if (n < 0 || glm::dot(points[size_t(n)].normal, points[k].normal) < ALIKE) continue;
        const glm::vec3 away = (points[size_t(n)].position - points[k].position) / (WIDTH * cell_m);
        const float w = std::exp(-0.5f * glm::dot(away, away));
        weights += w;
        means[k].irradiance += w * lights[size_t(n)].far.irradiance;
        means[k].variance += w * w * lights[size_t(n)].far.variance;
      }
    }
    means[k].irradiance /= weights;
    means[k].variance /= weights * weights;
  });
  return means;
}

/// What of a change is not noise (James and Stein's factor, of one number).
float share_to_trust(float change, float variance) {
  return change * change > variance ? 1.0f - variance / (change * change) : 0.0f;
}

}  // namespace

void Contacts::run(const VoxelGrid& voxels, const EmbreeScene& embree, FinalGatherCpu& gather,
                   const ContactPicture& picture, std::span<const glm::vec4> positions, const gl::Texture& into,
                   gl::PassTimer& timer) {
  const auto scope = timer.scope(name);
  pixels_ = 0;
  const FinalGatherCpu::Near near = gather.near_light(voxels, embree);
  const float least = BRIGHT * near.mean;
  const bool any =
      least > 0.0f && std::any_of(near.irradiance.begin(), near.irradiance.end(), [&](float e) { return e >= least; });
  if (!any) return;
  const std::vector<glm::vec4> normals = download(picture.gbuffer.normals());
  const std::vector<Pixel> pixels = pixels_at_contacts(voxels, near.irradiance, least, positions, normals,
                                                       size_t(picture.paths) / LEAST_PATHS_OF_PIXEL);
  if (pixels.empty()) return;
  pixels_ = pixels.size();
  const int paths = std::min(picture.paths / int(pixels.size()), MOST_PATHS_OF_PIXEL);
  const std::vector<ContactPoint> points = points_of(pixels, picture, positions, normals);
  const ContactSides sides{gather.radiosity(), near.from_far};
  const std::vector<ContactLight> found = contact_light(voxels, embree, sides, points, paths);
  const std::vector<ContactPart> far = evened(pixels, points, found, picture.gbuffer.size(), voxels.grid().cell_size_m);

  const std::vector<glm::vec4> albedos = download(picture.gbuffer.albedo());
  std::vector<glm::vec4> changed = download(into);
  std::vector<std::vector<glm::vec4>> others;
  for (const gl::Texture* layer : picture.layers) {
    if (layer != &into) others.push_back(download(*layer));
  }
  for (size_t k = 0; k < pixels.size(); ++k) {
    const size_t i = pixels[k].index;
    glm::vec3 now(changed[i]);
    for (const auto& layer : others) now += glm::vec3(layer[i]);
    const glm::vec3 reflectance = glm::vec3(albedos[i]) * glm::one_over_pi<float>();
    const glm::vec3 change = reflectance * (found[k].near.irradiance + far[k].irradiance) - now;
    const float variance = level(reflectance) * level(reflectance) * (found[k].near.variance + far[k].variance);
    changed[i] += glm::vec4(share_to_trust(level(change), variance) * change, 0.0f);
  }
  const glm::ivec2 size = into.size();
  glTextureSubImage2D(into.id(), 0, 0, 0, size.x, size.y, GL_RGBA, GL_FLOAT, changed.data());
}

}  // namespace volgi::screen
