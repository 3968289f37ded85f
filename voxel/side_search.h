#pragma once
#include <array>
#include <cstring>
#include <glm/glm.hpp>
#include <vector>

#include "voxel/voxel_grid.h"

namespace volgi {

/// Which sides stand for a point of a surface: at most one for each axis, with the weights |n_x| : |n_y| : |n_z| over
/// those found (they sum to 1, or to 0 where no side faces alike). Twin of shaders/voxel/find_side.glsl.
struct SidesOfPoint {
  glm::ivec3 sides{-1};
  glm::vec3 weights{0.0f};
};

/// @param front  1 or 0: only sides that show a triangle's front or back, and that do not hide the point behind another
///               surface; -1: any, of cells that see the point or are open to the one that does: a cell whose centre is
///               inside of a closed box has nothing of the light on the ground beside it.
SidesOfPoint sides_of_point(const VoxelGrid& voxels, glm::vec3 world_position, glm::vec3 normal, int front);

/// Which cells have a side on a face, and whether it shows a front, as bits that run along the face's axis: a column of
/// cells is asked at once. For many searches. Memory: 3 bytes a cell.
class SideColumns {
 public:
  explicit SideColumns(const VoxelGrid& voxels);

  /// The columns of one face. Bit k of what they answer: the cell `first` + k of the column (b, c) has a side with that
  /// `front`; 16 bits, `first` from -16 on, columns from two outside the grid on.
  struct Columns {
    const std::uint8_t* column_bytes = nullptr;
    const std::uint8_t* around_bytes = nullptr;
    int stride_b = 0, stride_c = 0;  // bytes between columns
    int origin = 0;                  // offset of column (0, 0), and its first cell, which need not be there

    int offset(int b, int c) const { return origin + stride_b * b + stride_c * c; }
    std::uint32_t column(int offset, int first) const { return read(column_bytes + offset, first); }
    /// Any of the column and the eight around it.
    std::uint32_t around(int offset, int first) const { return read(around_bytes + offset, first); }

   private:
    static std::uint32_t read(const std::uint8_t* bytes, int first) {
      std::uint32_t word;
      std::memcpy(&word, bytes + (first >> 3), sizeof word);
      return word >> (first & 7);
    }
  };
  Columns of_face(int face, int front) const {
    const Layout& l = layout_[size_t(face >> 1)];
    const size_t kind = size_t(face) + 6 * size_t(front);
    return {columns_[kind].data(), around_[kind].data(), l.stride, l.stride * l.columns_b, byte(face, 0, 0)};
  }

 private:
  using Bytes = std::vector<std::uint8_t>;
  static constexpr int kPad = 2;  // bytes before and after a column, and columns around the grid
  struct Layout {
    int stride, columns_b, columns_c;  // all padded
    int outside;                       // bytes of what lies before the blocks that are held
  };

  void fill(const VoxelGrid& voxels, const VoxelGrid::Leaf& leaf);
  void spread(int kind);
  int byte(int face, int b, int c) const {
    const Layout& l = layout_[size_t(face >> 1)];
    return kPad + l.stride * (kPad + b + l.columns_b * (kPad + c)) - l.outside;
  }

  std::array<Layout, 3> layout_;
  std::array<Bytes, 12> columns_, around_;  // by face, then front
};

/// The same for many points of one plane, and for one or both of its sides at once.
class SideSearch {
 public:
  /// @param columns  of the same voxels: saves time where there are many searches; may be null. Needs front 0 or 1, and
  ///                 cells not farther outside the grid than one.
  /// @param front    of the sides that `normal` asks for; with `both`, sides with 1 - front are searched against it.
  /// @param at_rim   with front -1: what sees the points is outside of the grid, and only their own surface stands for
  /// them.
  SideSearch(const VoxelGrid& voxels, const SideColumns* columns, glm::vec3 normal, int front, bool both,
             bool at_rim = false);

  struct Answer {
    SidesOfPoint along, against;  // the normal
    bool place_matters = false;   // another point of the plane in the same cell may get other ones
  };
  /// @param point  in cell units, and the cell that it lies in; for front -1 the one that sees it.
  Answer at(const glm::vec3& point, const glm::ivec3& cell) const;

 private:
  /// First sides of an axis whose normals are alike (within 45 degrees), and within 90. They vary where points of the
  /// cell differ in how near they are.
  struct Found {
    int alike = -1;
    int facing = -1;
    bool alike_varies = false;
    bool facing_varies = false;
  };

  /// What a search along one axis needs to know of the plane.
  struct Axis {
    float slope_b, slope_c, slope;  // slope: at most this between neighbouring columns
    int to_face;                    // steps_to_face()
    int faces[2];                   // of the cells that see it: along the normal, against it
    int below[2];                   // how far these are below the face between the two
    SideColumns::Columns columns[2];
  };
  /// A column in which the plane passes the centre at `depth`.
  struct Column {
    int b, c, face;  // the face that the plane blocks there
    float depth;
  };
  /// Where the point is on the axis, and the cell that it lies in.
  struct Place {
    float at, low;
    const glm::vec3& point;
    const glm::ivec3& seeing;  // with front -1
  };

  void prepare(int axis, const SideColumns* columns);
  template <int axis>
  Answer at_one_axis(const glm::vec3& point, const glm::ivec3& cell) const;
  template <int axis>
  void find(const glm::vec3& point, const glm::ivec3& own, Found* found) const;
  template <int axis>
  Column column_at(const glm::vec3& point, int b, int c) const;
  template <int axis>
  void find_around(const glm::vec3& point, const glm::ivec3& own, int searching, Found* found) const;
  template <int axis>
  void find_around_quick(const glm::vec3& point, const glm::ivec3& own, int searching, Found* found) const;
  template <int axis>
  bool look(const Column& column, std::uint32_t three, const Place& place, int way, Found& found) const;
  template <int axis>
  std::uint32_t cells_with_side(const Column& column, int way) const;
  template <int axis>
  int side_at_once(const Column& column, const Place& place, int way) const;
  template <int axis>
  bool any_side_around(const Column& own, int way) const;
  template <int axis>
  Place place_of(const glm::vec3& point, const glm::ivec3& own) const;
  bool is_open_to(const Place& place, const glm::ivec3& cell, const glm::vec3& normal) const;
  template <int axis>
  static glm::ivec3 cell_at(const Column& column, int cell);
  template <int axis>
  std::uint32_t side_of(const Column& column, int cell, int way) const;
  SidesOfPoint weighted(const Found (&by_axis)[3][2], int way, bool& place_matters) const;

  const VoxelGrid& voxels_;
  const SideColumns* columns_;
  glm::vec3 normals_[2];
  int fronts_[2];
  int ways_;
  bool at_rim_;
  int searched_axes_ = 0;    // bits
  glm::vec3 weights_{0.0f};  // where all of them find a side
  Axis axes_[3];
};

}  // namespace volgi
