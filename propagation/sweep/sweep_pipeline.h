#pragma once
#include <tbb/cache_aligned_allocator.h>

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "voxel/side_halo.h"

namespace volgi {

/// What the sweeps of a part of a grid do when: the octants' ways through it in chunks of blocks along x, each as soon
/// as the parts upwind have handed on what comes in. One rank alone has eight tasks, an octant each: all at once, or
/// one by one in the same planes where those of eight would take more than kManyFlows.
///
/// The KBA algorithm (Koch, Baker and Alcouffe 1992): a rank has columns of blocks along x; for each chunk of them it
/// waits for the outflow of the ranks before it along y and z, sweeps, and hands its own on at once. All four corners
/// of the ranks start together, with two octants each. Of the tasks that are ready a rank takes the one with the most
/// stages still to come behind it, its own chunks and ranks downwind (the "depth of graph" priority, with which Adams
/// et al. 2013 have the least number of stages there can be). Octants depend on nothing of each other, so the order
/// changes no number.
///
/// Memory: of every octant, or of the one whose turn it is, what goes through y and z in a chunk, twice where it comes
/// from or goes to another rank, and where there is more than one chunk what waits for the next one, a face for each
/// row of blocks. Messages hold the faces that light goes through, and a byte each.
class SweepPipeline {
 public:
  struct Task {
    int octant, chunk;
  };
  /// Light through the faces of blocks across one axis, by flow: x of the chunk fastest, then y or z of the part.
  struct Plane {
    unsigned char* lit;  // elsewhere values are of no meaning
    float* values;
    size_t faces;
  };

  static constexpr size_t kManyFlows = size_t(128) << 20;  // bytes

  /// @param ranks  null: there is one. @param face_floats  of a block's face. @param many_flows  for tests, in place of
  /// kManyFlows.
  SweepPipeline(const RanksOfVolume* ranks, const BlockBox& part, size_t face_floats, size_t many_flows = kManyFlows);

  int chunks() const { return chunks_; }
  int chunk_blocks() const { return chunk_blocks_; }
  bool alone() const { return ranks_ == nullptr; }
  /// All ranks: a new sweep of all octants. @param in_order  one octant after the other, also where they need not.
  void start(bool in_order);
  /// Tasks that can be done now, `most` of them; waits until there is one. None: all are done.
  std::vector<Task> next(size_t most);
  /// What comes in through an axis (1 or 2) and, after the task, goes out.
  Plane plane(Task task, int axis);
  /// Whether no part lies upwind: what comes in there is the caller's to say.
  bool at_rim(int octant, int axis) const { return flows_[size_t(octant)][size_t(axis - 1)].from < 0; }
  /// What goes through x from chunk to chunk of a row of blocks; null where there is one chunk.
  float* carried(int octant, size_t row);
  unsigned char& carried_lit(int octant, size_t row) { return carried_lit_[size_t(octant)][row]; }
  /// Its outflow goes to the next ranks.
  void finished(Task task);
  /// All has been handed on.
  void end();

  size_t bytes() const;
  static size_t bytes_for(const RanksOfVolume* ranks, const BlockBox& part, size_t face_floats);
  /// Of all sweeps so far.
  struct Traffic {
    size_t messages = 0, bytes = 0;
  };
  const Traffic& traffic() const { return traffic_; }

 private:
  using Buffer = std::vector<std::byte, tbb::cache_aligned_allocator<std::byte>>;
  using MessagePtr = std::unique_ptr<Ranks::Message>;
  /// Of one octant through one axis.
  struct Flow {
    int from = -1, to = -1;             // ranks
    size_t faces = 0;                   // of a plane
    std::array<Buffer, 2> planes;       // of even and odd chunks; one where no rank is beside
    std::array<MessagePtr, 2> leaving;  // of these
    MessagePtr coming;
    int come = 0;  // chunks

    bool beside() const { return from >= 0 || to >= 0; }
    size_t place(int chunk) const { return beside() ? size_t(chunk & 1) : 0; }
  };
  static size_t header_bytes(size_t faces) { return (faces + 63) / 64 * 64; }
  static int chunk_blocks_of(const RanksOfVolume* ranks, const BlockBox& part);
  static size_t octant_bytes(const RanksOfVolume* ranks, const BlockBox& part, size_t face_floats);
  /// Whether octants take turns in the planes of one.
  static bool take_turns(const RanksOfVolume* ranks, size_t bytes_of_octant, size_t many_flows) {
    return ranks == nullptr && 8 * bytes_of_octant > many_flows;
  }
  static size_t faces_of(const BlockBox& part, int chunk_blocks, int axis) {
    return size_t(chunk_blocks) * size_t(part.size()[axis == 1 ? 2 : 1]);
  }

  bool progress();
  bool is_ready(int octant);
  int stages_behind(int octant) const;
  void unpack(Buffer& plane, size_t faces) const;
  size_t pack(Buffer& plane, size_t faces) const;
  void wait_for_messages();

  const RanksOfVolume* ranks_;
  glm::ivec3 size_;  // of the part
  size_t face_floats_;
  int chunk_blocks_, chunks_;
  bool in_turn_;
  std::array<std::array<Flow, 2>, 8> flows_;  // by octant; through y, through z. in_turn_: the first has all planes
  std::array<std::vector<float, tbb::cache_aligned_allocator<float>>, 8> carried_;
  std::array<std::vector<unsigned char>, 8> carried_lit_;
  std::array<int, 8> done_{};  // chunks
  bool in_order_ = false;
  Traffic traffic_;
};

}  // namespace volgi
