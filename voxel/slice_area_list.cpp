#include "voxel/slice_area_list_internal.h"

#include "voxel/slice_blocks_internal.h"

namespace volgi::slicing {

namespace {

/// Lists what triangles cover of the cells of one block.
class BlockAreas {
 public:
  using Scratch = AreaList::Scratch;

  BlockAreas(const SlicedScene& s, std::uint32_t block, Scratch& scratch)
      : s_(s), first_cell_(s.block_cell(block)), areas_(first_cell_, scratch) {
    for (int axis = 0; axis < 3; ++axis) windows_[axis] = block_window(s, first_cell_, axis);
  }

  void add(std::uint32_t index) {
    const SliceTriangle& t = s_.triangles[index];
    if (t.normal == glm::vec3(0.0f)) return;
    Window window = windows_[t.nearest_axis];
    if (!cut(window, fine_box(t), t.nearest_axis)) return;
    if (t.nearest_axis == 0) slice<0>(t, index, window);
    if (t.nearest_axis == 1) slice<1>(t, index, window);
    if (t.nearest_axis == 2) slice<2>(t, index, window);
  }

  /// Null when there are none.
  std::unique_ptr<BlockFaces> collect() {
    if (areas_.empty()) return nullptr;
    auto out = std::make_unique<BlockFaces>();
    areas_.move_to(*out);
    return out;
  }

 private:
  template <int axis>
  void slice(const SliceTriangle& t, std::uint32_t index, const Window& window) {
    const Long3 n = plane_normal(t);
    const TriangleSlice<axis> triangle(t, n);
    if (triangle.flat() && !t.may_pass) {
      slice_flat<axis>(triangle, window);
    } else if (!t.may_pass) {
      slice_sloped<axis>(triangle, window, [](int, int) { return 1.0f; });
    } else {
      const TriangleMaterial material(s_, t, n, axis, kLineFootprint);
      slice_sloped<axis>(triangle, window, [&](int b, int c) { return material.at(b, c).stopped; });
    }
    areas_.end_triangle(index, axis);
  }

  template <int axis, class Stopped>
  void slice_sloped(const TriangleSlice<axis>& triangle, const Window& window, const Stopped& stopped_at) {
    constexpr int b = axis == 2 ? 0 : axis + 1, c = axis == 0 ? 2 : axis - 1;
    const int fine_b = kFine * first_cell_[b], fine_c = kFine * first_cell_[c];
    const int first_segment = kFine * first_cell_[axis];
    triangle.fragments(window, [&](int column_b, int column_c, int k, std::int64_t numerator) {
      const float stopped = stopped_at(column_b, column_c);
      if (!(stopped > 0.0f)) return;
      const auto depth = [&] { return float(triangle.depth(numerator)); };
      const size_t at_b = size_t(column_b - fine_b), at_c = size_t(column_c - fine_c);
      const size_t at_segment = size_t(k + 1 - first_segment);
      const int layer = areas_.layer(at_segment, AreaList::depth_decides(at_segment) ? depth() : 0.0f, axis);
      areas_.add(kFineTable.cell[at_b], kFineTable.cell[at_c], layer,
                 kFineTable.sub[at_b] + kFine * kFineTable.sub[at_c], stopped, depth);
    });
  }

  template <int axis>
  void slice_flat(const TriangleSlice<axis>& triangle, const Window& window) {
    int layer = 0;
    float depth = 0.0f;
    flat_cells<axis>(
        triangle, window, first_cell_,
        [&](size_t at_segment, float flat_depth) {
          depth = flat_depth;
          layer = areas_.layer(at_segment, depth, axis);
        },
        [&](int cell_b, int cell_c, std::uint32_t subs) { areas_.add_cell(cell_b, cell_c, layer, subs, depth); });
  }

  const SlicedScene& s_;
  glm::ivec3 first_cell_;
  Window windows_[3];
  AreaList areas_;
};

}  // namespace

BlockTable list_areas(const SlicedScene& s) { return for_all_blocks<BlockAreas>(s); }

}  // namespace volgi::slicing
