#pragma once
#include <cstdlib>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

#include "voxel/voxel_grid.h"

namespace volgi {

/// Leaves of 8^3 cells by number, z fastest, so that leaves that share most cache lines are neighbours in memory too.
class LeafNumbers {
 public:
  explicit LeafNumbers(glm::ivec3 cells)
      : LeafNumbers(BlockBox{glm::ivec3(0), (cells + (kLeafCells - 1)) / kLeafCells},
                    BlockBox{glm::ivec3(0), (cells + (kLeafCells - 1)) / kLeafCells}) {}
  /// Of a rank: those of its part, and those around them that it looks at.
  LeafNumbers(const BlockBox& held, const BlockBox& part) : first_(held.first), blocks_(held.size()), part_(part) {}
  int count() const { return blocks_.x * blocks_.y * blocks_.z; }
  glm::ivec3 blocks() const { return blocks_; }
  int number(glm::ivec3 block) const {
    block -= first_;
    return block.z + blocks_.z * (block.y + blocks_.y * block.x);
  }
  glm::ivec3 block(int number) const {
    const int column = number / blocks_.z;
    return first_ + glm::ivec3(column / blocks_.y, column % blocks_.y, number - column * blocks_.z);
  }
  /// Whether it is of the part.
  bool own(int number) const { return part_.contains(block(number)); }
  const BlockBox& part() const { return part_; }
  /// Leaf across face `face` of leaf `number`; -1 outside the grid.
  int beside(int number, int face) const;

 private:
  glm::ivec3 first_{0}, blocks_;
  BlockBox part_;
};

/// Lobes of a volume's cells, sparse: a leaf of 8^3 cells for each block that holds light, [coefficient][band][512]
/// floats, 64-byte aligned, and a table of leaves by number. Reading a block without light gives zeros.
class LobeVolume {
 public:
  LobeVolume(const LeafNumbers& numbers, int coefficients);

  /// Numbers of the leaves that there are, ascending.
  std::span<const int> leaves() const { return leaves_; }
  const float* leaf(int number) const { return table_[size_t(number)]; }
  float* leaf(int number) { return table_[size_t(number)]; }  // only of leaves(): the others are one leaf of zeros
  size_t leaf_floats() const { return leaf_floats_; }
  /// Two states that are larger together are not found in the cache again.
  static size_t cache_bytes();
  /// The leaf of zeros.
  static const float* dark();

  /// These leaves and no others, their lobes unset; a leaf that there was keeps its memory. @param numbers  ascending.
  void assign(std::vector<int> numbers);
  /// These as well, which there were not. @param numbers  ascending.
  void add(const std::vector<int>& numbers);
  /// Of a leaf that there is: rows (LeafLight) in which its memory may hold anything but zeros. All rows, unless the
  /// writer of the leaf says which.
  std::uint64_t& rows_written(int number) { return rows_written_[size_t(slot_of_[size_t(number)])]; }
  /// Leaves dropped (as flags over leaves()) read as zeros from now on.
  void drop(std::span<const char> dropped);
  void swap(LobeVolume& other) noexcept;
  size_t bytes() const;
  /// What bytes() will be where so many leaves hold light.
  static size_t bytes_for(const LeafNumbers& numbers, int coefficients, size_t leaves);

 private:
  struct Free {
    void operator()(float* p) const { std::free(p); }
  };
  using Chunk = std::unique_ptr<float[], Free>;
  void add_slots();
  float* slot(int index) const;
  void release(int number);
  static size_t chunk_bytes(size_t chunk_leaves, size_t leaf_floats);

  size_t leaf_floats_;
  size_t chunk_leaves_;
  std::vector<Chunk> chunks_;  // kept between passes
  std::vector<int> leaves_;
  std::vector<float*> table_;
  std::vector<int> slot_of_;                 // by number; -1: none
  std::vector<int> free_;                    // slots
  std::vector<std::uint64_t> rows_written_;  // by slot
};

}  // namespace volgi
