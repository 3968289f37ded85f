#pragma once
#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "voxel/grid.h"
#include "voxel/part.h"

namespace volgi {

/// What nested grids there are to be. Trivially copyable, as all of VolumeOptions.
struct CascadeOptions {
  static constexpr int kMostLevels = 8;
  int levels = 1;          // grids, the outermost among them; 1: it alone
  int ratio = 2;           // 2 or 4: edge of a grid's cells over that of the next one inside
  glm::vec3 around{0.0f};  // where the inner ones lie [m], in the scene's centred frame
  bool by_boxes = false;   // they lie there instead, from the outermost of the inner ones:
  std::array<GridBox, kMostLevels - 1> boxes{};

  bool nested() const { return levels > 1; }
};

/// Nested grids ("cascades" of Kaplanyan and Dachsbacher 2010): the outermost
/// holds the scene, and each next one takes the place of a box of the one around it, with cells of 1/ratio of the edge.
/// Boxes are of whole blocks of 8^3 cells of the grid around them, so that as their place moves they move by whole
/// cells, and the same cells always lie in the same place. Between two boxes are blocks of the grid between, but at the
/// outermost one's rim.
struct Cascade {
  int ratio = 2;
  std::vector<Grid> grids;       // outermost first
  std::vector<BlockBox> inside;  // by grid: its blocks that the next one takes the place of; empty for the last

  size_t levels() const { return grids.size(); }
  bool covers(size_t level, glm::ivec3 block) const { return inside[level].contains(block); }
  /// The innermost grid that holds a point [m], with `margin` of its own cells around; the outermost holds all.
  size_t level_of(glm::vec3 point, float margin = 0.0f) const;
  /// The whole scene's cells as if all were as small as the innermost grid's.
  glm::ivec3 finest_cells() const;
};

/// @param outermost  its cells are made up to whole blocks where there are several levels; alone it stays as it is.
///   Inner grids have as many cells along each axis as the outermost along its longest, but none beyond it.
/// @throws Error(usage) for a ratio that is neither 2 nor 4, levels that are not 1 to kMostLevels, and a box that is
/// not in the
///   outermost grid; Error(over_limit) where the scene is longer than kMostFinestCells of the innermost cells.
Cascade make_cascade(const Grid& outermost, const CascadeOptions& options);

bool same_cascade(const Cascade& a, const Cascade& b);

/// As far from a grid as vertices are told apart from one another (voxel/slice_scene.cpp).
constexpr int kMostFinestCells = 1280;

}  // namespace volgi
