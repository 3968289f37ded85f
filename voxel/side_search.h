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
///               surface; -1: any.
SidesOfPoint sides_of_point(const VoxelGrid& voxels, glm::vec3 world_position, glm::vec3 normal, int front);

/// Which cells have a side on a face, and whether it shows a front, as bits that run along the face's axis: a column of
/// cells is asked at once. For many searches. Memory: 3 bytes a cell.
class SideColumns {
 public:
  explicit SideColumns(const VoxelGrid& voxels);

  /// The columns of one face. Bit k of what they answer: the cell `first` + k of the column (b, c) has a side with that
  /// `front`; 16 bits, `first` from -16 on.
  struct Columns {
    const std::uint8_t* column_bytes = nullptr;
    const std::uint8_t* around_bytes = nullptr;
    int stride_b = 0, stride_c = 0;

    std::uint32_t column(int b, int c, int first) const { return read(column_bytes, b, c, first); }
    /// Any of the column and the eight around it.
    std::uint32_t around(int b, int c, int first) const { return read(around_bytes, b, c, first); }

   private:
    std::uint32_t read(const std::uint8_t* bytes, int b, int c, int first) const {
      std::uint32_t word;
      std::memcpy(&word, bytes + (stride_b * b + stride_c * c + (first >> 3)), sizeof word);
      return word >> (first & 7);
    }
  };
  Columns of_face(int face, int front) const {
    const Layout& l = layout_[size_t(face >> 1)];
    const size_t kind = size_t(face + 6 * front);
    return {columns_[kind].data() + kPad, around_[kind].data() + kPad, l.stride, l.stride * l.columns_b};
  }

 private:
  using Bytes = std::vector<std::uint8_t>;
  static constexpr int kPad = 2;  // bytes before and after a column
  struct Layout {
    int stride, columns_b, columns_c;
  };

  void fill(const VoxelGrid& voxels, const VoxelGrid::Leaf& leaf);
  void spread(int kind);
  size_t byte(int face, int b, int c) const {
    const Layout& l = layout_[size_t(face >> 1)];
    return size_t(kPad + l.stride * (b + l.columns_b * c));
  }

  std::array<Layout, 3> layout_;
  std::array<Bytes, 12> columns_, around_;  // by face, then front
};

/// The same for many points of one plane, and for one or both of its sides at once.
class SideSearch {
 public:
  /// @param columns  of the same voxels: saves time where there are many searches; may be null. Needs front 0 or 1.
  /// @param front    of the sides that `normal` asks for; with `both`, 1 - front is asked for against it.
  SideSearch(const VoxelGrid& voxels, const SideColumns* columns, glm::vec3 normal, int front, bool both);

  struct Answer {
    SidesOfPoint along, against;  // the normal
    bool place_matters = false;   // another point of the plane in the same cell may get other ones
  };
  /// @param point  in cell units, and the cell that it lies in.
  Answer at(glm::vec3 point, glm::ivec3 cell) const;

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
    float slope_b, slope_c, slope;  // slope: at most so much between neighbouring columns
    int faces[2];                   // of the cells that see it: along the normal, against it
    int below[2];                   // how far these are below the face between the two
    SideColumns::Columns columns[2];
  };
  /// A column in which the plane passes the centre at `depth`.
  struct Column {
    int b, c, face;  // the face that the plane blocks there
    float depth;
    bool near, all_near;  // to the point; to all points of the cell
  };

  template <int axis>
  void find(glm::vec3 point, glm::ivec3 own, Found* found) const;
  template <int axis>
  bool look(const Column& column, int way, Found& found) const;
  int anybody_around(int axis, const Column& own) const;
  std::uint32_t cells_with_side(int face, int b, int c, int first) const;
  template <int axis>
  int side_at_once(const Column& column, int way) const;
  SidesOfPoint weighted(const Found (&by_axis)[3][2], int way, bool& place_matters) const;

  const VoxelGrid& voxels_;
  const SideColumns* columns_;
  glm::vec3 normals_[2];
  int fronts_[2];
  int ways_;
  Axis axes_[3];
};

}  // namespace volgi
