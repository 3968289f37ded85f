#include "propagation/sweep/nested_faces.h"

#include <algorithm>

#include "voxel/cascade_voxels.h"

namespace volgi {

namespace {

using sweep::kBlockCells;
using sweep::kBlockFace;

bool goes_up(int octant, int axis) { return ((octant >> axis) & 1) != 0; }

/// Axes of a block's face: along the cells of a row, and along rows (sweep::Block).
glm::ivec2 axes_of_face(int axis) { return {axis == 0 ? 1 : 0, axis == 2 ? 1 : 2}; }

/// As the flow meets them.
std::array<float, kBlockFace> by_flow(const std::array<float, kBlockFace>& going_up, int octant, int axis) {
  const glm::ivec2 axes = axes_of_face(axis);
  std::array<float, kBlockFace> out;
  for (int row = 0; row < kBlockCells; ++row) {
    const int from_row = goes_up(octant, axes.y) ? row : kBlockCells - 1 - row;
    for (int i = 0; i < kBlockCells; ++i) {
      const int from_i = goes_up(octant, axes.x) ? i : kBlockCells - 1 - i;
      out[size_t(row * kBlockCells + i)] = going_up[size_t(from_row * kBlockCells + from_i)];
    }
  }
  return out;
}

bool any_light(const float* values, size_t count) {
  return std::any_of(values, values + count, [](float v) { return v != 0.0f; });
}

size_t faces_across(glm::ivec3 blocks, int axis) {
  const glm::ivec2 axes = axes_of_face(axis);
  return size_t(blocks[axes.x]) * size_t(blocks[axes.y]);
}

}  // namespace

NestedFaces::NestedFaces(const Cascade& cascade, std::span<const VoxelGrid> levels, size_t face_floats, int octants)
    : cascade_(cascade), face_floats_(face_floats) {
  for (size_t level = 1; level < cascade.levels(); ++level) {
    Level inner;
    inner.blocks = leaf_blocks(cascade.grids[level]);
    inner.planes.resize(size_t(octants));
    for (Planes& planes : inner.planes) {
      for (int axis = 0; axis < 3; ++axis) {
        const size_t faces = faces_across(inner.blocks, axis);
        planes.values[size_t(axis)].resize(faces * face_floats);
        planes.lit[size_t(axis)].resize(faces);
      }
    }
    inner_.push_back(std::move(inner));
    weigh(level, levels);
  }
}

/// Where the rim stops light: by the cells outside, of which `level` - 1 has them.
void NestedFaces::weigh(size_t level, std::span<const VoxelGrid> levels) {
  const VoxelGrid &outside = levels[level - 1], &inside = levels[level];
  for_each_cell_at_rim(cascade_, level - 1, [&](glm::ivec3 cell, int face, glm::ivec3 first) {
    const float passes = open_share(outside, cell, face);
    if (passes == 1.0f) return;
    const int axis = shared::face_axis(face), back = shared::opposite_face(face);
    const glm::ivec2 axes = axes_of_face(axis);
    for (int k = 0; k < cascade_.ratio * cascade_.ratio; ++k) {
      glm::ivec3 fine = first;
      fine[axes.x] += k % cascade_.ratio;
      fine[axes.y] += k / cascade_.ratio;
      std::map<int, Weights>& of_rim = inner_[level - 1].weights[size_t(back)];
      auto [weights, is_new] = of_rim.try_emplace(int(face_index(level, fine / kLeafCells, axis)));
      if (is_new) weights->second.fill(1.0f);
      const int place = (fine[axes.y] % kBlockCells) * kBlockCells + fine[axes.x] % kBlockCells;
      weights->second[size_t(place)] = passes > 0.0f ? open_share(inside, fine, back) / passes : 0.0f;
    }
  });
}

size_t NestedFaces::face_index(size_t level, glm::ivec3 block, int axis) const {
  const glm::ivec2 axes = axes_of_face(axis);
  return size_t(block[axes.x]) + size_t(inner_[level - 1].blocks[axes.x]) * size_t(block[axes.y]);
}

NestedFaces::Faces NestedFaces::faces(int slot, size_t level, glm::ivec3 block) {
  Planes& planes = inner_[level - 1].planes[size_t(slot)];
  Faces faces;
  for (int axis = 0; axis < 3; ++axis) {
    const size_t at = face_index(level, block, axis);
    faces[size_t(axis)] = {planes.values[size_t(axis)].data() + at * face_floats_, &planes.lit[size_t(axis)][at]};
  }
  return faces;
}

glm::ivec3 NestedFaces::first_inside(size_t level, glm::ivec3 block) const {
  return cascade_.ratio * (block - cascade_.inside[level].first);
}

template <class Visit>
void NestedFaces::for_each_part(int slot, int octant, size_t level, glm::ivec3 block, int axis, bool downwind,
                                const Visit& visit) {
  const int ratio = cascade_.ratio;
  const glm::ivec2 axes = axes_of_face(axis);
  const glm::ivec3 first = first_inside(level, block);
  int part[2];
  for (part[1] = 0; part[1] < ratio; ++part[1]) {
    for (part[0] = 0; part[0] < ratio; ++part[0]) {
      glm::ivec3 inner = first;
      inner[axis] += goes_up(octant, axis) == downwind ? ratio - 1 : 0;
      for (int a = 0; a < 2; ++a) inner[axes[a]] += goes_up(octant, axes[a]) ? part[a] : ratio - 1 - part[a];
      visit(part, faces(slot, level + 1, inner)[size_t(axis)], inner);
    }
  }
}

void NestedFaces::enter(const sweep::Kernels& kernels, int octets, int slot, int octant, size_t level, glm::ivec3 block,
                        const Faces& outside) {
  for (int axis = 0; axis < 3; ++axis) {
    glm::ivec3 upwind = block;
    upwind[axis] -= goes_up(octant, axis) ? 1 : -1;
    if (cascade_.covers(level, upwind)) continue;
    const Face& from = outside[size_t(axis)];
    for_each_part(slot, octant, level, block, axis, false, [&](const int(&part)[2], Face to, glm::ivec3) {
      *to.lit = *from.lit;
      if (*from.lit != 0) kernels.refine_face(octets, cascade_.ratio, part, from.values, to.values);
    });
  }
}

void NestedFaces::leave(const sweep::Kernels& kernels, int octets, int slot, int octant, size_t level, glm::ivec3 block,
                        const Faces& outside) {
  for (int axis = 0; axis < 3; ++axis) {
    glm::ivec3 downwind = block;
    downwind[axis] += goes_up(octant, axis) ? 1 : -1;
    if (cascade_.covers(level, downwind)) continue;
    const Face& to = outside[size_t(axis)];
    const std::map<int, Weights>& of_rim = inner_[level].weights[size_t(shared::face_of(axis, goes_up(octant, axis)))];
    std::fill(to.values, to.values + face_floats_, 0.0f);
    for_each_part(slot, octant, level, block, axis, true, [&](const int(&part)[2], Face from, glm::ivec3 inner) {
      if (*from.lit == 0) return;
      const auto weights = of_rim.find(int(face_index(level + 1, inner, axis)));
      if (weights == of_rim.end()) {
        kernels.coarsen_face(octets, cascade_.ratio, part, from.values, nullptr, to.values);
      } else {
        kernels.coarsen_face(octets, cascade_.ratio, part, from.values, by_flow(weights->second, octant, axis).data(),
                             to.values);
      }
    });
    *to.lit = any_light(to.values, face_floats_) ? 1 : 0;
  }
}

size_t NestedFaces::bytes_for(const Cascade& cascade, size_t face_floats) {
  size_t bytes = 0;
  for (size_t level = 1; level < cascade.levels(); ++level) {
    for (int axis = 0; axis < 3; ++axis)
      bytes += faces_across(leaf_blocks(cascade.grids[level]), axis) * (face_floats * sizeof(float) + 1);
  }
  return bytes;
}

size_t NestedFaces::bytes() const {
  size_t bytes = 0;
  for (const Level& level : inner_) {
    for (const auto& of_rim : level.weights) bytes += of_rim.size() * (sizeof(Weights) + 6 * sizeof(void*));
  }
  return inner_.empty() ? 0 : bytes + inner_[0].planes.size() * bytes_for(cascade_, face_floats_);
}

}  // namespace volgi
