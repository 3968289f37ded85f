#include "voxel/voxel_grid.h"

#include <openvdb/Types.h>
#include <openvdb/tree/Tree.h>

namespace volgi {

namespace {

/// Bits of side.shared.h for a cell that has sides `first` ... `last` - 1.
std::uint32_t face_bits(const std::vector<shared::Side>& sides, size_t first, size_t last) {
  std::uint32_t bits = 0;
  for (size_t i = first; i < last; ++i) {
    bits |= 1u << sides[i].face;
    if (sides[i].coverage >= 1.0f) bits |= 256u << sides[i].face;
  }
  return bits;
}

}  // namespace

VoxelGrid::VoxelGrid(const Grid& grid, std::vector<shared::Side> sides)
    : grid_(grid),
      blocks_(leaf_blocks(grid)),
      held_{glm::ivec3(0), blocks_},
      part_(held_),
      sides_(std::move(sides)),
      part_sides_(sides_.size()),
      tree_(vdb::make_int64_tree()),
      leaves_(held_.count(), nullptr) {
  std::vector<Leaf*> writable(leaves_.size(), nullptr);
  for (size_t first = 0, last = 0; first < sides_.size(); first = last) {
    while (last < sides_.size() && sides_[last].cell == sides_[first].cell) ++last;
    const glm::ivec3 cell = shared::cell_coord(grid_, sides_[first].cell);
    Leaf*& leaf = writable[size_t(block_index(blocks_, cell / kLeafCells))];
    if (leaf == nullptr) leaf = tree_->touchLeaf(openvdb::Coord(cell.x, cell.y, cell.z));
    leaf->setValueOn(openvdb::Index(leaf_offset(cell)), pack({std::uint32_t(first), face_bits(sides_, first, last)}));
  }
  leaves_.assign(writable.begin(), writable.end());
  point_to_cells();
}

VoxelGrid::VoxelGrid(const Grid& grid, std::vector<shared::Side> sides, const std::vector<Leaf*>& leaves,
                     const BlockBox& held, const BlockBox& part, size_t part_sides)
    : grid_(grid),
      blocks_(leaf_blocks(grid)),
      held_(held),
      part_(part),
      sides_(std::move(sides)),
      part_sides_(part_sides),
      tree_(vdb::make_int64_tree()),
      leaves_(leaves.begin(), leaves.end()) {
  for (Leaf* leaf : leaves) {
    if (leaf != nullptr) tree_->addLeaf(leaf);
  }
  point_to_cells();
}

VoxelGrid::VoxelGrid(const Grid& grid, std::vector<shared::Side> sides, const std::vector<Leaf*>& leaves)
    : VoxelGrid(grid, std::move(sides), leaves, {glm::ivec3(0), leaf_blocks(grid)}, {glm::ivec3(0), leaf_blocks(grid)},
                0) {
  part_sides_ = sides_.size();
}

void VoxelGrid::point_to_cells() {
  leaf_cells_.reserve(leaves_.size());
  for (const Leaf* leaf : leaves_) leaf_cells_.push_back(leaf == nullptr ? nullptr : leaf->buffer().data());
}

size_t VoxelGrid::bytes_for(const BlockBox& held, size_t sides, size_t leaves) {
  CellSidesTree one(0);
  if (leaves > 0) one.touchLeaf(openvdb::Coord(0, 0, 0));
  const size_t all = held.count();
  // Nodes of 16^3 leaves come with their leaves; a grid of at most 256 cells has eight of them.
  const glm::ivec3 nodes = (held.last + 15) / 16 - held.first / 16;
  const size_t more_nodes = size_t(nodes.x) * size_t(nodes.y) * size_t(nodes.z) - 1;
  using Node = CellSidesTree::RootNodeType::ChildNodeType::ChildNodeType;
  const size_t tree = one.memUsage() + (leaves > 0 ? (leaves - 1) * Leaf(openvdb::Coord(), 0).memUsage() : 0);
  return tree + more_nodes * sizeof(Node) + sides * sizeof(shared::Side) + 2 * all * sizeof(const Leaf*);
}

size_t VoxelGrid::bytes() const {
  return tree_->memUsage() + sides_.size() * sizeof(shared::Side) + 2 * leaves_.size() * sizeof(const Leaf*);
}

}  // namespace volgi
