#include "voxel/sliced_voxelization.h"

#include <algorithm>
#include <bit>

#include "core/gl/raster_state.h"

namespace volgi {

namespace {
constexpr int kGroup = 256;      // list_sides_*.comp.glsl
constexpr int kAreaSamples = 4;  // along each edge of a face; 16 of them count its area to 6 % at an edge
}  // namespace

void VoxelGridGl::bind() const {
  grid_block.bind_uniform(0);
  cell_sides.bind_storage(3);
  sides.bind_storage(4);
  side_count.bind_storage(5);
}

std::vector<shared::Side> VoxelGridGl::download_sides() const {
  auto count = side_count.download<std::uint32_t>(1)[0];
  return sides.download<shared::Side>(count);
}

SlicedVoxelization::SlicedVoxelization(const Grid& grid)
    : slice_(gl::Program::raster("voxel/slice")),
      count_(gl::Program::compute("voxel/list_sides_count.comp.glsl")),
      scan_(gl::Program::compute("voxel/list_sides_scan.comp.glsl")),
      offset_(gl::Program::compute("voxel/list_sides_offset.comp.glsl")),
      side_area_(gl::Program::raster("voxel/side_area")),
      collect_area_(gl::Program::compute("voxel/collect_area.comp.glsl")) {
  voxels_.grid = grid;
  voxels_.grid_block = gl::Buffer(sizeof(Grid), &grid);
  voxels_.cell_sides = gl::Buffer(8 * cell_count(grid));
  voxels_.side_count = gl::Buffer(sizeof(std::uint32_t));
  voxels_.side_count.clear();
  counted_ = std::make_unique<gl::Readback>(sizeof(std::uint32_t), 2);
  groups_ = int((cell_count(grid) + kGroup - 1) / kGroup);
  group_totals_ = gl::Buffer(sizeof(std::uint32_t) * size_t(groups_));
  for (int axis = 0; axis < 3; ++axis) {
    size_t bytes = sizeof(std::uint32_t) * size_t(shared::face_count(grid, axis));
    key_low_[axis] = gl::Buffer(bytes);
    key_high_[axis] = gl::Buffer(bytes);
    opacity_[axis] = gl::Buffer(bytes);
    const glm::ivec2 columns(grid.cells[shared::axis_b(axis)], grid.cells[shared::axis_c(axis)]);
    columns_[axis] = gl::Framebuffer::without_attachments(columns);
    fine_columns_[axis] = gl::Framebuffer::without_attachments(kAreaSamples * columns);
  }
}

void SlicedVoxelization::run(const gl::SceneBuffers& scene, gl::PassTimer& timer) {
  {
    auto scope = timer.scope("voxel/slice");
    for (int axis = 0; axis < 3; ++axis) {
      const std::uint32_t far_away = 0xffffffffu;
      glClearNamedBufferData(key_low_[axis].id(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &far_away);
      glClearNamedBufferData(key_high_[axis].id(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &far_away);
      opacity_[axis].clear();
    }
    slice(scene, false);
  }
  {
    auto scope = timer.scope("voxel/list_sides");
    list_sides();
  }
  std::uint32_t count = 0;
  counted_->push(voxels_.side_count);
  if (voxels_.side_capacity == 0 || counted_->pending() > 1) {
    counted_->pop(&count);
    make_room(count);
  }
  {
    auto scope = timer.scope("voxel/slice");
    slice(scene, true);
  }
  auto scope = timer.scope("voxel/side_area");
  count_area(scene);
}

void SlicedVoxelization::make_room(std::uint32_t side_count) {
  if (voxels_.side_capacity != 0 && side_count <= voxels_.side_capacity) return;
  voxels_.side_capacity = side_count + side_count / 5 + 64;
  voxels_.sides = gl::Buffer(sizeof(shared::Side) * size_t(voxels_.side_capacity));
  area_fixed_ = gl::Buffer(sizeof(std::uint32_t) * size_t(voxels_.side_capacity));
}

void SlicedVoxelization::slice(const gl::SceneBuffers& scene, bool write_sides) {
  voxels_.bind();
  slice_.use();
  slice_.set("write_sides", int(write_sides));
  slice_.set("triangle_bits", std::max(8, int(std::bit_width(scene.triangle_count()))));
  for (int axis = 0; axis < 3; ++axis) {
    slice_.set("axis", axis);
    key_low_[axis].bind_storage(0);
    key_high_[axis].bind_storage(1);
    opacity_[axis].bind_storage(2);
    gl::begin_fullscreen_pass();  // no depth test: all fragments count
    columns_[axis].bind();
    scene.draw(slice_);
  }
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

void SlicedVoxelization::count_area(const gl::SceneBuffers& scene) {
  area_fixed_.clear();
  voxels_.bind();
  area_fixed_.bind_storage(0);
  side_area_.use();
  side_area_.set("samples_per_cell", float(kAreaSamples));
  for (int axis = 0; axis < 3; ++axis) {
    side_area_.set("axis", axis);
    gl::begin_fullscreen_pass();
    fine_columns_[axis].bind();
    scene.draw(side_area_);
  }
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  collect_area_.use();
  gl::dispatch({int(voxels_.side_capacity), 1, 1}, {64, 1, 1});
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

void SlicedVoxelization::list_sides() {
  voxels_.bind();
  for (GLuint axis = 0; axis < 3; ++axis) opacity_[axis].bind_storage(axis);
  group_totals_.bind_storage(4);
  count_.use();
  glDispatchCompute(GLuint(groups_), 1, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  scan_.use();
  scan_.set("groups", groups_);
  glDispatchCompute(1, 1, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  offset_.use();
  glDispatchCompute(GLuint(groups_), 1, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

size_t SlicedVoxelization::bytes() const {
  size_t sum = voxels_.bytes() + group_totals_.bytes() + area_fixed_.bytes();
  for (int axis = 0; axis < 3; ++axis) sum += key_low_[axis].bytes() + key_high_[axis].bytes() + opacity_[axis].bytes();
  return sum;
}

}  // namespace volgi
