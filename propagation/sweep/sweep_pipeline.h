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
/// waits for the outflow of the ranks before it along y and z, sweeps, and hands its own on at once. Two opposite
/// corners of the ranks start together, with two octants each, then the other two: a rank has room for some octants at
/// once (octants_at_once()), and begins the next one, in an order that is the same everywhere, when one has left it.
/// (The first that is not through everywhere has room on all ranks, and all that it waits for is under way: so none
/// waits for ever, whatever room each has.) Of the tasks that are ready a rank takes the one with the most stages still
/// to come behind it, its own chunks and ranks downwind (the "depth of graph" priority, with which Adams et al. 2013
/// have the least number of stages there can be). Octants depend on nothing of each other, so the order changes no
/// number.
///
/// Memory: of as many octants as are under way at once, what goes through y and z in a chunk, twice where it comes from
/// or goes to another rank, and where there is more than one chunk what waits for the next one, a face for each row of
/// blocks. Messages hold the faces that light goes through, and a byte each.
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

  static constexpr size_t kManyFlows = size_t(128) << 20;       // bytes, of one rank
  static constexpr size_t kManyFlowsOfRank = size_t(16) << 20;  // of each of several

  /// How many octants are under way at once: of one rank all eight, or one where they would take more than many_flows;
  /// of several ranks eight, or four, with hardly more waiting, where they would take more than kManyFlowsOfRank, or
  /// two where those are to be lean (propagation/sweep/sweep_model.h says what that costs).
  struct AtOnce {
    size_t many_flows = kManyFlows;
    int of_ranks = 0;  // 0: as above
    int of_one = 0;    // rank; 0: as above
  };

  /// @param ranks  null: there is one. @param face_floats  of a block's face. @param at_once  for tests.
  SweepPipeline(const RanksOfVolume* ranks, const BlockBox& part, size_t face_floats, AtOnce at_once);

  int chunks() const { return chunks_; }
  int chunk_blocks() const { return chunk_blocks_; }
  int octants_at_once() const { return int(slots_.size()); }
  /// Which of the octants under way at once this one is: 0 ... octants_at_once() - 1, or -1.
  int slot(int octant) const { return slot_[size_t(octant)]; }
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
  unsigned char& carried_lit(int octant, size_t row) { return slot_of(octant).carried_lit[row]; }
  /// Its outflow goes to the next ranks.
  void finished(Task task);
  /// All has been handed on.
  void end();

  size_t bytes() const;
  static size_t bytes_for(const RanksOfVolume* ranks, const BlockBox& part, size_t face_floats, AtOnce at_once);
  static size_t bytes_for(const RanksOfVolume* ranks, const BlockBox& part, size_t face_floats) {
    return bytes_for(ranks, part, face_floats, AtOnce());
  }
  /// What octants_at_once() will be of one rank.
  static int octants_at_once(const BlockBox& part, size_t face_floats, AtOnce at_once);
  /// Of all sweeps so far.
  struct Traffic {
    size_t messages = 0, bytes = 0;
  };
  const Traffic& traffic() const { return traffic_; }

 private:
  using Buffer = std::vector<std::byte, tbb::cache_aligned_allocator<std::byte>>;
  using MessagePtr = std::unique_ptr<Ranks::Message>;
  using Planes = std::array<Buffer, 2>;  // of even and odd chunks; one where no rank is beside
  /// What is kept of an octant while it is under way.
  struct Slot {
    std::array<Planes, 2> planes;  // through y, through z
    std::vector<float, tbb::cache_aligned_allocator<float>> carried;
    std::vector<unsigned char> carried_lit;
  };
  /// Of one octant through one axis.
  struct Flow {
    int from = -1, to = -1;             // ranks
    size_t faces = 0;                   // of a plane
    std::array<MessagePtr, 2> leaving;  // of the slot's planes
    MessagePtr coming;
    int come = 0;  // chunks

    bool beside() const { return from >= 0 || to >= 0; }
    size_t place(int chunk) const { return beside() ? size_t(chunk & 1) : 0; }
    bool leaves() const { return leaving[0] != nullptr || leaving[1] != nullptr; }
  };
  static size_t header_bytes(size_t faces) { return (faces + 63) / 64 * 64; }
  static int chunk_blocks_of(const RanksOfVolume* ranks, const BlockBox& part);
  static size_t octant_bytes(const RanksOfVolume* ranks, const BlockBox& part, size_t face_floats);
  static int slots_of(const RanksOfVolume* ranks, size_t bytes_of_octant, AtOnce at_once);
  static size_t faces_of(const BlockBox& part, int chunk_blocks, int axis) {
    return size_t(chunk_blocks) * size_t(part.size()[axis == 1 ? 2 : 1]);
  }

  bool begun(int octant) const { return slot_[size_t(octant)] >= 0; }
  Slot& slot_of(int octant) { return slots_[size_t(slot_[size_t(octant)])]; }
  Buffer& buffer(int octant, int a, size_t place) { return slot_of(octant).planes[size_t(a)][place]; }
  void make_flows(const BlockBox& part);
  void begin_octants();
  bool take_what_left(int octant);
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
  std::vector<Slot> slots_;
  std::array<std::array<Flow, 2>, 8> flows_;  // by octant; through y, through z
  std::array<int, 8> done_{};                 // chunks
  std::array<int, 8> order_{};                // in which octants begin
  int next_ = 0;                              // of these
  std::array<int, 8> slot_{};                 // by octant; -1: it has not begun, or is through
  bool in_order_ = false;
  Traffic traffic_;
};

}  // namespace volgi
