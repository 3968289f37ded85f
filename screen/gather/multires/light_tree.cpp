#include "screen/gather/multires/light_tree.h"

#include <algorithm>

#include "shaders/screen/base/slots.shared.h"
#include "shaders/screen/gather/multires/light_node.shared.h"
#include "shaders/screen/gather/multires/slots.shared.h"
#include "shaders/screen/visibility/area_maps/slots.shared.h"
#include "shaders/shared/group_sizes.shared.h"
#include "shaders/shared/near_light.shared.h"

namespace volgi::screen {

namespace {

constexpr int kLeavesPerChunk = LINEAR_GROUP;  // LEAVES_PER_CHUNK of light_leaves.glsl

/// Of the topmost nodes: more leaves in each than clusters have in the mean, by fours, so that most clusters have one.
int top_level_for(int leaves, int clusters) {
  int level = 0;
  while (level + 1 < MAX_LIGHT_TREE_LEVELS && int64_t(clusters) << (2 * level) <= leaves) ++level;
  return level;
}

int chunks_of(int leaves) { return (leaves + kLeavesPerChunk - 1) / kLeavesPerChunk; }

void wait_for_nodes() { glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT); }

}  // namespace

LightTree::LightTree(float zone)
    : zone_(zone),
      assign_(gl::Program::compute("screen/gather/multires/light_tree_assign.comp.glsl")),
      counts_program_(gl::Program::compute("screen/gather/multires/light_tree_counts.comp.glsl")),
      roots_program_(gl::Program::compute("screen/gather/multires/light_tree_roots.comp.glsl")),
      leaves_program_(gl::Program::compute("screen/gather/multires/light_tree_leaves.comp.glsl")),
      level_program_(gl::Program::compute("screen/gather/multires/light_tree_level.comp.glsl")) {}

void LightTree::make_room(int leaves, int clusters) {
  leaves_ = leaves;
  clusters_ = clusters;
  top_level_ = top_level_for(leaves, clusters);
  most_roots_ = (leaves >> (2 * top_level_)) + clusters;
  size_t nodes = 0;
  for (int level = 0; level <= top_level_; ++level) nodes += size_t(most_roots_) << (2 * (top_level_ - level));
  const GLuint before = nodes_.id();
  gl::reserve(nodes_, nodes * sizeof(shared::LightNode));
  if (nodes_.id() != before) node_texels_ = gl::Texture::view_of(nodes_, GL_RGBA32F, sizeof(glm::vec4));
  gl::reserve(roots_, size_t(clusters + 1) * sizeof(GLint));
  gl::reserve(leaf_clusters_, size_t(std::max(leaves, 1)) * sizeof(GLuint));
  gl::reserve(chunk_counts_, size_t(std::max(chunks_of(leaves), 1)) * size_t(clusters) * sizeof(GLint));
}

void LightTree::set_shape(const gl::Program& program) const {
  program.set("top_level", top_level_);
  program.set("most_roots", most_roots_);
  program.set("cluster_count", clusters_);
  program.set("leaf_count", leaves_);
  program.set("in_parts", in_parts_ ? 1 : 0);
}

void LightTree::run(const VirtualLightListGl& lights, const VirtualLightSubdivision* parts,
                    const VirtualAreaLights& clusters, float scene_diagonal_m, gl::PassTimer& timer) {
  const auto scope = timer.scope(name);
  in_parts_ = parts != nullptr;
  make_room(lights.count() * (in_parts_ ? FINE_SUBLIGHTS : 1), clusters.count());
  nodes_.clear();
  lights.buffer.bind_storage(VIRTUAL_LIGHTS_SLOT);
  clusters.buffer().bind_uniform(AREA_LIGHTS_BLOCK);
  roots_.bind_storage(TREE_ROOTS_SLOT);
  nodes_.bind_storage(TREE_NODES_SLOT);
  (in_parts_ ? parts->sublights() : nodes_).bind_storage(TREE_SUBLIGHTS_SLOT);
  leaf_clusters_.bind_storage(TREE_LEAF_CLUSTERS_SLOT);
  chunk_counts_.bind_storage(TREE_CHUNK_COUNTS_SLOT);
  for (const gl::Program* program : {&assign_, &counts_program_, &roots_program_, &leaves_program_, &level_program_})
    set_shape(*program);

  assign_.set("scene_diagonal_m", std::max(scene_diagonal_m, 1e-30f));
  assign_.use();
  gl::dispatch_linear(size_t(leaves_), kLeavesPerChunk);
  wait_for_nodes();
  counts_program_.use();
  gl::dispatch_linear(size_t(clusters_), LINEAR_GROUP);
  wait_for_nodes();
  roots_program_.use();
  gl::dispatch({1, 1, 1}, {1, 1, 1});
  wait_for_nodes();
  leaves_program_.use();
  gl::dispatch_linear(size_t(leaves_), kLeavesPerChunk);
  wait_for_nodes();
  level_program_.use();
  for (int level = 1; level <= top_level_; ++level) {
    level_program_.set("level", level);
    gl::dispatch_linear(size_t(most_roots_) << (2 * (top_level_ - level)), LINEAR_GROUP);
    wait_for_nodes();
  }
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

void LightTree::bind(const gl::Program& program) const {
  node_texels_.bind(LIGHT_NODES_UNIT);
  roots_.bind_storage(LIGHT_ROOTS_SLOT);
  program.set("top_level", top_level_);
  program.set("most_roots", most_roots_);
  program.set("zone", zone_);
  program.set("area_light_count", clusters_);
  program.set("seen_level", in_parts_ ? LIGHT_LEVEL : 0);
}

}  // namespace volgi::screen
