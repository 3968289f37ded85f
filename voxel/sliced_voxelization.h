#pragma once
#include <array>
#include <memory>
#include <optional>

#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "core/gl/readback.h"
#include "core/gl/scan.h"
#include "core/gl/scene_buffers.h"
#include "voxel/expected_sides.h"
#include "voxel/voxel_grid_gl.h"
#include "voxel/voxelization_options.h"

namespace volgi {

/// 3-way sliced voxelization (Gaitatzes 2010, Algorithm 1), timers "voxel/slice", "voxel/list_sides" and
/// "voxel/side_area". Twin of voxelize_cpu.
///
/// Lines three times finer than the columns of cells are cut into pieces at three nodes a cell. Which pieces surfaces
/// block is decided exactly, and a face's coverage is the share of the ways between its two cells' centres that are
/// blocked: a continuous surface leaves no gap, however thin or sloped, and what is thinner than a cell still counts
/// (docs/theory.md#voxelization). Each covered face has two sides, with the albedo, normal and emission of the surface
/// nearest to the cell that sees it. We depart from the paper, which keeps one normal and colour per cell by MAX
/// blending: in a wall thinner than a cell these cancel and leak (docs/theory.md#sides). Alpha: MASK cuts, BLEND covers
/// the share alpha of a face. Results do not depend on the order of fragments.
///
/// Cost: two raster passes per axis (or two in all), one for areas, a few over the faces and cells. Memory while it
/// runs: 20 bytes a face (about 60 a cell; 24 a face where materials have alpha), 96 bytes a face that surfaces cross;
/// kept for the next frame. All buffers stay under 128 MiB up to 256^3 cells.
class SlicedVoxelization {
 public:
  explicit SlicedVoxelization(const Grid& grid, VoxelizationOptions options = {});

  /// Voxelizes the scene, as the options say. Only the first run waits for the number of sides. A later one with a
  /// fifth more sides than there is room for leaves some out of that frame, though what is closed stays closed; the
  /// next one makes room.
  void run(const gl::SceneBuffers& scene, gl::PassTimer& timer);
  /// The next run waits for the number of sides as the first one does: a scene that has moved gets all of its sides,
  /// those that a new object would find.
  void count_again() { count_and_wait_ = true; }
  /// One interleaved run (VoxelizationOptions::interleave), along this axis. The first one, and any of a single_pass,
  /// is a full one.
  void run(const gl::SceneBuffers& scene, gl::PassTimer& timer, int axis);

  const VoxelGridGl& voxels() const { return voxels_; }
  size_t bytes() const;

 private:
  /// The faces of one axis.
  struct Family {
    gl::Buffer key_low, key_high;  // nearest surface to the lower and upper cell (shaders/voxel/keys.glsl)
    gl::Buffer blocked, haze;      // what blocks fine lines; haze only where materials have alpha
    gl::Buffer entries, surfaces;  // place in the list of surfaces; the list, 48 bytes each, two for a face
    gl::Buffer coverage;
    std::uint32_t capacity = 0;  // of surfaces, in faces
  };
  struct PlacedBuffer {
    int place;  // *_PLACE of shaders/voxel/slots.shared.h
    gl::Buffer Family::*buffer;
  };
  /// Per axis the faces that surfaces cross, then sides.
  using Wanted = std::array<std::uint32_t, 4>;

  const char* base_name() const;
  void run_axes(const gl::SceneBuffers& scene, gl::PassTimer& timer, int first_axis, int last_axis);
  void mark(const gl::SceneBuffers& scene, int first_axis, int last_axis);
  void number_surfaces(int axis);
  void write_surfaces(const gl::SceneBuffers& scene, int first_axis, int last_axis);
  void raster(const gl::SceneBuffers& scene, const gl::Program& program, int first_axis, int last_axis,
              std::initializer_list<PlacedBuffer> buffers);
  void find_coverage();
  void list_sides();
  void fill_sides();
  void count_area(const gl::SceneBuffers& scene, int first_axis, int last_axis);
  void count_surfaces(int first_axis, int last_axis);
  void make_room_for_surfaces(int axis);
  void make_room_for_sides();

  VoxelizationMethod method_;
  bool interleave_;
  int next_axis_ = 0;                                           // of an interleaved run
  std::array<std::optional<gl::Program>, 2> mark_, side_area_;  // without and with alpha, made when needed
  gl::Program write_;
  gl::Program number_, coverage_, count_, offset_, fill_, collect_area_;
  gl::Scan scan_;
  VoxelGridGl voxels_;
  std::array<Family, 3> families_;
  gl::Buffer wanted_buffer_;  // Wanted
  gl::Buffer group_totals_;
  gl::Buffer area_fixed_;
  gl::Framebuffer columns_;
  std::unique_ptr<gl::Readback> counted_;  // Wanted of earlier frames
  Wanted wanted_{};
  int groups_ = 0;
  bool count_and_wait_ = true;
  bool alpha_ = false;  // some material cuts or covers in part
};

/// Sides that a SlicedVoxelization makes room for where it counts so many.
std::uint32_t side_capacity_for(size_t sides);
/// GPU memory [bytes] that a SlicedVoxelization will take, for limits that are checked before allocating.
size_t voxelization_bytes(const Grid& grid, const Scene& scene, const ExpectedSides& expected);

}  // namespace volgi
