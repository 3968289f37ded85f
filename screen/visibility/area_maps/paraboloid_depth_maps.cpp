#include "screen/visibility/area_maps/paraboloid_depth_maps.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>

#include "shaders/screen/visibility/area_maps/slots.shared.h"
#include "shaders/shared/group_sizes.shared.h"

namespace volgi::screen {
namespace {

// Layers are drawn so many tiles at once, with room for this many triangles in each in the mean. What does not fit is
// drawn where it is found: slower.
constexpr size_t kTilesAtOnce = size_t(1) << 18;
constexpr size_t kTrianglesPerTile = 12, kLeastCapacity = size_t(1) << 19;
constexpr size_t kTilesPerBand = 256;
constexpr size_t kHeadBytes = 2 * sizeof(GLuint);
constexpr size_t kTileBytes = 2 * sizeof(GLuint);
constexpr GLuint kTileGroups = 1024;                // share out the tiles; enough to fill a GPU
constexpr int kTileTexels = 16;                     // TILE_TEXELS of paraboloid_triangle.glsl
constexpr GLsizei kTrianglesPerDispatch = 1 << 21;  // GL promises 65535 groups

size_t tiles_of(int resolution, int layers) {
  const auto across = size_t((resolution + kTileTexels - 1) / kTileTexels);
  return across * across * size_t(layers);
}

int layers_at_once(int resolution, int layers) {
  return std::min(layers, int(std::max(kTilesAtOnce / tiles_of(resolution, 1), size_t(1))));
}

GLuint tile_capacity(int resolution, int layers) {
  return GLuint(std::max(kTrianglesPerTile * tiles_of(resolution, layers_at_once(resolution, layers)), kLeastCapacity));
}

}  // namespace

ParaboloidDepthMaps::ParaboloidDepthMaps(int resolution, int layers)
    : resolution_(resolution),
      layers_(layers),
      distance_(gl::Texture::make_2d_array(GL_R32F, resolution, resolution, layers)),
      tiles_(kHeadBytes + tile_capacity(resolution, layers) * kTileBytes),
      tile_ends_(tiles_of(resolution, layers) * sizeof(GLuint)) {
  assert(resolution >= 1 && resolution <= 4096 && layers <= MAX_VIRTUAL_AREA_LIGHTS);
  const auto programs = [](const std::vector<std::string>& defines) {
    return Programs{gl::Program::compute("screen/visibility/area_maps/paraboloid_depth_maps.comp.glsl", defines),
                    gl::Program::compute("screen/visibility/area_maps/paraboloid_depth_maps_tiles.comp.glsl", defines)};
  };
  opaque_ = programs({});
  alpha_ = programs({"ALPHA"});
}

void ParaboloidDepthMaps::run(const gl::SceneBuffers& scene, const VirtualAreaLights& lights, gl::PassTimer& timer) {
  run(scene, lights.buffer(), lights.count(), timer);
}

void ParaboloidDepthMaps::run(const gl::SceneBuffers& scene, const gl::Buffer& area_lights, int count,
                              gl::PassTimer& timer) {
  const auto scope = timer.scope(name);
  constexpr float nothing = std::numeric_limits<float>::infinity();
  distance_.clear({nothing, nothing, nothing, nothing});
  area_lights.bind_storage(MAPPED_AREA_LIGHTS_SLOT);
  tiles_.bind_storage(MAP_TILES_SLOT);
  tile_ends_.bind_storage(MAP_TILE_ENDS_SLOT);
  // Atomic operations want integers.
  glBindImageTexture(DISTANCE_BITS_IMAGE, distance_.id(), 0, GL_TRUE, 0, GL_READ_WRITE, GL_R32UI);
  for (const Programs* programs : {&opaque_, &alpha_}) {
    programs->triangles.set("resolution", resolution_);
    programs->tiles.set("resolution", resolution_);
  }
  // Both programs of alpha read the material.
  const auto visit = [&](const gl::SceneBuffers::Triangles& triangles) {
    draw(triangles.opaque ? opaque_ : alpha_, triangles, std::min(count, layers_));
  };
  scene.visit_triangles(VERTICES_SLOT, {&alpha_.triangles, &alpha_.tiles}, visit);
  glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
}

void ParaboloidDepthMaps::draw(const Programs& programs, const gl::SceneBuffers::Triangles& triangles,
                               int layers) const {
  for (GLsizei done = 0; done < triangles.count; done += kTrianglesPerDispatch) {
    const GLsizei count = std::min(triangles.count - done, kTrianglesPerDispatch);
    programs.triangles.set("first_triangle", triangles.first + done);
    programs.triangles.set("triangle_count", count);
    const int step = layers_at_once(resolution_, layers_);
    for (int layer = 0; layer < layers; layer += step)
      draw_layers(programs, count, layer, std::min(step, layers - layer));
  }
}

void ParaboloidDepthMaps::draw_layers(const Programs& programs, GLsizei triangles, int first, int layers) const {
  const std::array<GLuint, 2> head{0, tile_capacity(resolution_, layers_)};
  tiles_.upload(head.data(), sizeof head);
  tile_ends_.clear();
  programs.triangles.set("first_layer", first);
  programs.triangles.use();
  const auto bands = GLsizei(std::max(tiles_of(resolution_, 1) / kTilesPerBand, size_t(1)));
  gl::dispatch({triangles, layers, bands}, {LINEAR_GROUP, 1, 1});
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  programs.tiles.set("first_layer", first);
  programs.tiles.set("layers", layers);
  programs.tiles.use();
  glDispatchCompute(kTileGroups, 1, 1);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
}

size_t ParaboloidDepthMaps::bytes() const {
  return size_t(resolution_) * size_t(resolution_) * size_t(layers_) * sizeof(float) + tiles_.bytes() +
         tile_ends_.bytes();
}

}  // namespace volgi::screen
