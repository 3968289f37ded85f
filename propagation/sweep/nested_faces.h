#pragma once
#include <tbb/cache_aligned_allocator.h>

#include <array>
#include <map>
#include <span>
#include <vector>

#include "propagation/sweep/sweep_kernel.h"
#include "voxel/cascade.h"
#include "voxel/voxel_grid.h"

namespace volgi {

/// Light on its way through the inner grids of a cascade: what goes through faces of blocks across each axis, as it is
/// when a sweep has come so far, and how it gets from a grid into the one inside and out again.
///
/// Into the finer grid the power through a face is shared out evenly among the ratio^2 faces that it is made of; on the
/// way out these add up. So no power is lost or made, none is negative, and the way back is the way there
/// (docs/theory.md#cascades). Where the two grids' faces have sides, the fine ones say place by place what passes
/// (1 - tau each); the coarse side's own mean share, which the kernel takes off afterwards, is divided out.
/// Memory: three planes of each inner grid, for each octant under way.
class NestedFaces {
 public:
  struct Face {
    float* values = nullptr;  // of no meaning where it is not lit
    unsigned char* lit = nullptr;
  };
  /// Of a block across x, y and z.
  using Faces = std::array<Face, 3>;

  /// @param cascade, levels  must outlive this. @param octants  under way at once.
  NestedFaces(const Cascade& cascade, std::span<const VoxelGrid> levels, size_t face_floats, int octants);

  /// @param slot  of the octant, below `octants`. @param level  from 1 on. Not at the same time for blocks of which one
  ///   is downwind of the other.
  Faces faces(int slot, size_t level, glm::ivec3 block);

  /// The first block, along the flow, of those that take a block's place; they are next to each other, `ratio` an axis.
  glm::ivec3 first_inside(size_t level, glm::ivec3 block) const;
  /// Before a block of `level` that the next level takes the place of is swept: light that comes in at that level's
  /// rim goes to its faces.
  void enter(const sweep::Kernels& kernels, int octets, int slot, int octant, size_t level, glm::ivec3 block,
             const Faces& outside);
  /// And after it: what leaves through the rim comes back.
  void leave(const sweep::Kernels& kernels, int octets, int slot, int octant, size_t level, glm::ivec3 block,
             const Faces& outside);

  size_t bytes() const;
  /// Of one octant.
  static size_t bytes_for(const Cascade& cascade, size_t face_floats);

 private:
  struct Planes {
    std::array<std::vector<float, tbb::cache_aligned_allocator<float>>, 3> values;
    std::array<std::vector<unsigned char>, 3> lit;
  };
  using Weights = std::array<float, sweep::kBlockFace>;  // of a block's face: cells of a row fastest, going up
  struct Level {
    glm::ivec3 blocks{0};
    std::vector<Planes> planes;                     // by slot
    std::array<std::map<int, Weights>, 6> weights;  // by face of the rim, then index of the block's face
  };
  /// Calls visit(part, face of the inner level, its block) for all of a block's face.
  template <class Visit>
  void for_each_part(int slot, int octant, size_t level, glm::ivec3 block, int axis, bool downwind, const Visit& visit);
  size_t face_index(size_t level, glm::ivec3 block, int axis) const;
  void weigh(size_t level, std::span<const VoxelGrid> levels);

  const Cascade& cascade_;
  size_t face_floats_;
  std::vector<Level> inner_;  // of level 1 and on
};

}  // namespace volgi
