#include "screen/visibility/area_maps/paraboloid_depth_maps.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>

#include "shaders/screen/visibility/area_maps/slots.shared.h"
#include "shaders/shared/group_sizes.shared.h"

namespace volgi::screen {
namespace {

// Tiles that do not fit are drawn where they are found: slower, never wrong.
constexpr GLuint kTileCapacity = 1u << 19;
constexpr size_t kHeadBytes = 2 * sizeof(GLuint);
constexpr size_t kTileBytes = 2 * sizeof(GLuint);
constexpr GLuint kTileGroups = 1024;                // share out the tiles; enough to fill a GPU
constexpr int kTileTexels = 16;                     // TILE_TEXELS of paraboloid_triangle.glsl
constexpr GLsizei kTrianglesPerDispatch = 1 << 21;  // GL promises 65535 groups

size_t tiles_of(int resolution, int layers) {
  const auto across = size_t((resolution + kTileTexels - 1) / kTileTexels);
  return across * across * size_t(layers);
}

}  // namespace

ParaboloidDepthMaps::ParaboloidDepthMaps(int resolution, int layers)
    : resolution_(resolution),
      layers_(layers),
      distance_(gl::Texture::make_2d_array(GL_R32F, resolution, resolution, layers)),
      tiles_(kHeadBytes + kTileCapacity * kTileBytes),
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
    constexpr std::array<GLuint, 2> head{0, kTileCapacity};
    tiles_.upload(head.data(), sizeof head);
    tile_ends_.clear();
    programs.triangles.set("first_triangle", triangles.first + done);
    programs.triangles.set("triangle_count", count);
    programs.triangles.use();
    gl::dispatch({count, layers, 1}, {LINEAR_GROUP, 1, 1});
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
    programs.tiles.set("layers", layers);
    programs.tiles.use();
    glDispatchCompute(kTileGroups, 1, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  }
}

size_t ParaboloidDepthMaps::bytes() const {
  return size_t(resolution_) * size_t(resolution_) * size_t(layers_) * sizeof(float) + tiles_.bytes() +
         tile_ends_.bytes();
}

}  // namespace volgi::screen
