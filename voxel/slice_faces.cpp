#include <cmath>
#include <memory>

#include "voxel/slice_area_list_internal.h"
#include "voxel/slice_blocks_internal.h"

namespace volgi::slicing {

namespace {

constexpr int kBlockCells = kLeafCells * kLeafCells * kLeafCells;
constexpr std::uint64_t kOffCentre = std::uint64_t(1) << 63;
constexpr std::uint64_t kNoKey = ~std::uint64_t(0);
constexpr int kOffsetStep[3] = {kLeafCells * kLeafCells, kLeafCells, 1};  // leaf_offset

/// Keys order the surfaces of a face: off-centre (63), depth (36 ... 62), sub-column (32 ... 35), triangle. Their depth
/// is as coarse as the 32-bit keys of slice.frag.glsl have it, so that ties are the same.
struct MarkedFace {
  std::uint32_t fine_blocked = 0;
  std::uint32_t alpha_sum = 0;
  std::uint64_t low = kNoKey;
  std::uint64_t high = kNoKey;
};

class BlockMarker {
 public:
  struct Scratch {
    std::array<std::array<MarkedFace, kBlockCells>, 3> faces;
    std::array<BlockMask, 3> active{};
    AreaList::Scratch areas;
  };

  BlockMarker(const SlicedScene& s, std::uint32_t block, Scratch& scratch)
      : s_(s), first_cell_(s.block_cell(block)), scratch_(scratch), areas_(first_cell_, scratch.areas) {
    const int triangle_bits = std::max(8, int(std::bit_width(s.triangle_count)));
    depth_max_ = (1u << (27 - triangle_bits)) - 1;
    for (int axis = 0; axis < 3; ++axis) windows_[axis] = block_window(s, first_cell_, axis);
  }

  void add(std::uint32_t index) {
    const SliceTriangle& t = s_.triangles[index];
    const FineBox box = fine_box(t);
    Window windows[3] = {windows_[0], windows_[1], windows_[2]};
    const bool meets[3] = {cut(windows[0], box, 0), cut(windows[1], box, 1), cut(windows[2], box, 2)};
    if (!meets[0] && !meets[1] && !meets[2]) return;
    const Long3 n = plane_normal(t);
    const auto slice_if = [&](auto opaque, auto passing, int axis) {
      if (meets[axis] && n[size_t(axis)] != 0) (this->*(t.may_pass ? passing : opaque))(t, index, n, windows[axis]);
    };
    slice_if(&BlockMarker::slice<0, false>, &BlockMarker::slice<0, true>, 0);
    slice_if(&BlockMarker::slice<1, false>, &BlockMarker::slice<1, true>, 1);
    slice_if(&BlockMarker::slice<2, false>, &BlockMarker::slice<2, true>, 2);
  }

  std::unique_ptr<BlockFaces> collect();

 private:
  /// What is the same for all fragments of a flat triangle.
  struct FlatFragments {
    int local, sub_segment, layer;
    float depth;
  };

  template <int axis, bool may_pass>
  void slice(const SliceTriangle& t, std::uint32_t index, const Long3& n, const Window& window);
  template <int axis>
  void slice_flat(std::uint32_t index, const TriangleSlice<axis>& triangle, const Window& window, bool counts_area);
  template <int axis>
  void mark_cell(std::uint32_t index, const FlatFragments& all, int cell_b, int cell_c, std::uint32_t subs,
                 bool counts_area);
  void mark_keys(MarkedFace& face, float depth, int i, bool centre, int sub, std::uint32_t triangle) const;

  const SlicedScene& s_;
  glm::ivec3 first_cell_;
  Scratch& scratch_;
  std::uint32_t depth_max_;
  Window windows_[3];
  AreaList areas_;
};

inline void BlockMarker::mark_keys(MarkedFace& face, float depth, int i, bool centre, int sub,
                                   std::uint32_t triangle) const {
  const float inside = glm::clamp(depth - float(i) + 0.5f, 0.0f, 1.0f);
  const std::uint32_t quantised = std::min(std::uint32_t(inside * float(depth_max_)), depth_max_ - 1);
  const std::uint64_t rest = (centre ? 0 : kOffCentre) | std::uint64_t(sub) << 32 | triangle;
  face.low = std::min(face.low, rest | std::uint64_t(quantised) << 36);
  face.high = std::min(face.high, rest | std::uint64_t(depth_max_ - 1 - quantised) << 36);
}

template <int axis, bool may_pass>
void BlockMarker::slice(const SliceTriangle& t, std::uint32_t index, const Long3& n, const Window& window) {
  constexpr int b = axis == 2 ? 0 : axis + 1, c = axis == 0 ? 2 : axis - 1;
  const int fine_b = kFine * first_cell_[b], fine_c = kFine * first_cell_[c];
  const int first_segment = kFine * first_cell_[axis];
  const bool counts_area = axis == t.nearest_axis && t.normal != glm::vec3(0.0f);
  MarkedFace* const faces = scratch_.faces[size_t(axis)].data();
  std::optional<TriangleMaterial> material;
  if constexpr (may_pass) material.emplace(s_, t, n, axis, kLineFootprint);
  const TriangleSlice<axis> triangle(t, n);
  if constexpr (!may_pass) {
    if (triangle.flat()) return slice_flat<axis>(index, triangle, window, counts_area);
  }
  triangle.fragments(window, [&](int column_b, int column_c, int k, std::int64_t numerator) {
    const size_t at_b = size_t(column_b - fine_b), at_c = size_t(column_c - fine_c);
    const size_t at_segment = size_t(k + 1 - first_segment);
    const int sub = kFineTable.sub[at_b] + kFine * kFineTable.sub[at_c];
    const bool centre = sub == 4;
    float stopped = 1.0f;
    if constexpr (may_pass) {
      stopped = material->at(column_b, column_c).stopped;
      if (!(stopped > 0.0f)) return;
    }
    const int cell_b = kFineTable.cell[at_b], cell_c = kFineTable.cell[at_c], local = kFineTable.cell[at_segment];
    MarkedFace& face = faces[cell_b * kOffsetStep[b] + cell_c * kOffsetStep[c] + local * kOffsetStep[axis]];
    if (!may_pass || stopped >= kOpaque) {
      face.fine_blocked |= 1u << (9 * kFineTable.sub[at_segment] + sub);
    } else if (centre) {
      face.alpha_sum += std::max(std::uint32_t(std::lround(-std::log(1.0f - stopped) * 65536.0f)), 1u);
    }
    const int offset = int(&face - faces);
    float depth = -1.0f;  // not known
    if (centre || face.low >= kOffCentre) {
      if (face.low == kNoKey) scratch_.active[axis][size_t(offset >> 6)] |= std::uint64_t(1) << (offset & 63);
      depth = float(triangle.depth(numerator));
      mark_keys(face, depth, first_cell_[axis] + local, centre, sub, index);
    }
    if (!counts_area) return;
    if (depth == -1.0f && AreaList::depth_decides(at_segment)) depth = float(triangle.depth(numerator));
    areas_.add(cell_b, cell_c, areas_.layer(at_segment, depth, axis), sub, stopped,
               [&] { return depth == -1.0f ? float(triangle.depth(numerator)) : depth; });
  });
  if (counts_area) areas_.end_triangle(index, axis);
}

/// The same for what lies across the axis, as most surfaces of buildings do: a cell's fragments at once.
template <int axis>
void BlockMarker::slice_flat(std::uint32_t index, const TriangleSlice<axis>& triangle, const Window& window,
                             bool counts_area) {
  FlatFragments all{};
  flat_cells<axis>(
      triangle, window, first_cell_,
      [&](size_t at_segment, float depth) {
        all = {kFineTable.cell[at_segment], kFineTable.sub[at_segment], areas_.layer(at_segment, depth, axis), depth};
      },
      [&](int cell_b, int cell_c, std::uint32_t subs) {
        mark_cell<axis>(index, all, cell_b, cell_c, subs, counts_area);
      });
  if (counts_area) areas_.end_triangle(index, axis);
}

template <int axis>
void BlockMarker::mark_cell(std::uint32_t index, const FlatFragments& all, int cell_b, int cell_c, std::uint32_t subs,
                            bool counts_area) {
  constexpr int b = axis == 2 ? 0 : axis + 1, c = axis == 0 ? 2 : axis - 1;
  constexpr std::uint32_t kCentre = 1u << 4;
  const int offset = cell_b * kOffsetStep[b] + cell_c * kOffsetStep[c] + all.local * kOffsetStep[axis];
  MarkedFace& face = scratch_.faces[axis][size_t(offset)];
  face.fine_blocked |= subs << (9 * all.sub_segment);
  // At the same depth the centre's key comes first, then that of the lowest sub-column.
  const bool centre = (subs & kCentre) != 0;
  if (centre || face.low >= kOffCentre) {
    if (face.low == kNoKey) scratch_.active[axis][size_t(offset >> 6)] |= std::uint64_t(1) << (offset & 63);
    mark_keys(face, all.depth, first_cell_[axis] + all.local, centre, centre ? 4 : std::countr_zero(subs), index);
  }
  if (counts_area) areas_.add_cell(cell_b, cell_c, all.layer, subs, all.depth);
}

std::unique_ptr<BlockFaces> BlockMarker::collect() {
  size_t count = 0;
  for (const BlockMask& mask : scratch_.active) {
    for (std::uint64_t word : mask) count += size_t(std::popcount(word));
  }
  if (count == 0) return nullptr;
  auto out = std::make_unique<BlockFaces>();
  out->faces.reserve(count);
  areas_.move_to(*out);
  out->active = scratch_.active;
  scratch_.active = {};
  for (size_t axis = 0; axis < 3; ++axis) {
    for (size_t word = 0; word < 8; ++word) {
      out->rank[axis][word] = std::uint16_t(out->faces.size());
      for (std::uint64_t rest = out->active[axis][word]; rest != 0; rest &= rest - 1) {
        MarkedFace& f = scratch_.faces[axis][64 * word + size_t(std::countr_zero(rest))];
        out->faces.push_back({f.fine_blocked, f.alpha_sum, std::uint32_t(f.low), std::uint32_t(f.high),
                              std::uint8_t((f.low >> 32) & 15), std::uint8_t((f.high >> 32) & 15)});
        f = MarkedFace{};
      }
    }
  }
  return out;
}

}  // namespace

BlockTable mark_faces(const SlicedScene& s) { return for_all_blocks<BlockMarker>(s); }

}  // namespace volgi::slicing
