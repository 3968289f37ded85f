#include "voxel/sliced_voxelization.h"

#include <algorithm>
#include <bit>
#include <cassert>

#include "core/gl/raster_state.h"
#include "shaders/shared/group_sizes.shared.h"
#include "shaders/voxel/groups.shared.h"
#include "shaders/voxel/slots.shared.h"

namespace volgi {

namespace {

constexpr size_t kSurfaceBytes = 2 * 48;        // surfaces.glsl, of a face
constexpr float kFootprintAlpha = 1.0f / 3.0f;  // cells: alpha belongs to a fine line,
constexpr float kFootprintAlbedo = 1.0f;        // albedo to a face

/// One after the other, for cells, faces or sides.
void dispatch_in_turn(size_t count, size_t group_size) {
  gl::dispatch_linear(count, group_size);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

/// FACE_LANES invocations to every VOXEL_GROUP of the faces.
void dispatch_shared_out(size_t count) {
  dispatch_in_turn((count + VOXEL_GROUP - 1) / VOXEL_GROUP * FACE_LANES, FACE_LANES);
}

bool has_alpha(const gl::SceneBuffers& scene) {
  return std::any_of(scene.materials().begin(), scene.materials().end(),
                     [](const Material& m) { return m.alpha_mode != AlphaMode::opaque; });
}

std::vector<std::string> alpha_define(bool alpha) {
  return alpha ? std::vector<std::string>{"ALPHA 1"} : std::vector<std::string>{};
}

std::uint32_t with_headroom(std::uint32_t count) { return count + count / 5 + 64; }

size_t faces(const Grid& grid, int axis) { return size_t(shared::face_count(grid, axis)); }

}  // namespace

SlicedVoxelization::SlicedVoxelization(const Grid& grid, VoxelizationOptions options)
    : method_(options.method),
      interleave_(options.interleave),
      number_(gl::Program::compute("voxel/number_surfaces.comp.glsl")),
      coverage_(gl::Program::compute("voxel/coverage.comp.glsl")),
      count_(gl::Program::compute("voxel/list_sides_count.comp.glsl")),
      offset_(gl::Program::compute("voxel/list_sides_offset.comp.glsl")),
      fill_(gl::Program::compute("voxel/list_sides_fill.comp.glsl")),
      collect_area_(gl::Program::compute("voxel/collect_area.comp.glsl")) {
  GLint storage_blocks = 0;
  glGetIntegerv(GL_MAX_FRAGMENT_SHADER_STORAGE_BLOCKS, &storage_blocks);
  if (storage_blocks < 12) method_ = VoxelizationMethod::sliced;  // the single pass binds three families at once
  write_ = gl::Program::raster(base_name(), std::vector<std::string>{"WRITE_SURFACES 1"});
  voxels_.grid = grid;
  voxels_.grid_block = gl::Buffer(sizeof(Grid), &grid);
  voxels_.cell_sides = gl::Buffer(8 * cell_count(grid));
  voxels_.side_count = gl::Buffer(sizeof(std::uint32_t));
  voxels_.side_count.clear();
  wanted_buffer_ = gl::Buffer(sizeof(Wanted));
  wanted_buffer_.clear();
  counted_ = std::make_unique<gl::Readback>(sizeof(Wanted), 1);
  groups_ = int((cell_count(grid) + VOXEL_GROUP - 1) / VOXEL_GROUP);
  group_totals_ = gl::Buffer(sizeof(std::uint32_t) * size_t(groups_));
  for (int axis = 0; axis < 3; ++axis) {
    Family& f = families_[size_t(axis)];
    for (gl::Buffer* b : {&f.key_low, &f.key_high, &f.blocked, &f.entries, &f.coverage}) {
      *b = gl::Buffer(sizeof(std::uint32_t) * faces(grid, axis));
    }
  }
  columns_ = gl::Framebuffer::without_attachments(glm::ivec2(std::max({grid.cells.x, grid.cells.y, grid.cells.z})));
}

const char* SlicedVoxelization::base_name() const {
  return method_ == VoxelizationMethod::sliced ? "voxel/slice" : "voxel/single_pass";
}

void SlicedVoxelization::run(const gl::SceneBuffers& scene, gl::PassTimer& timer) {
  if (!interleave_) return run_axes(scene, timer, 0, 2);
  run(scene, timer, next_axis_);
  next_axis_ = (next_axis_ + 1) % 3;
}

void SlicedVoxelization::run(const gl::SceneBuffers& scene, gl::PassTimer& timer, int axis) {
  assert(axis >= 0 && axis < 3);
  const bool full = voxels_.side_capacity == 0 || method_ == VoxelizationMethod::single_pass;
  run_axes(scene, timer, full ? 0 : axis, full ? 2 : axis);
}

void SlicedVoxelization::run_axes(const gl::SceneBuffers& scene, gl::PassTimer& timer, int first_axis, int last_axis) {
  {
    auto scope = timer.scope("voxel/slice");
    mark(scene, first_axis, last_axis);
    count_surfaces(first_axis, last_axis);
    for (int axis = first_axis; axis <= last_axis; ++axis) {
      make_room_for_surfaces(axis);
      number_surfaces(axis);
    }
    write_surfaces(scene, first_axis, last_axis);
  }
  {
    auto scope = timer.scope("voxel/list_sides");
    find_coverage();
    list_sides();
    fill_sides();
    counted_->push(wanted_buffer_);
  }
  auto scope = timer.scope("voxel/side_area");
  count_area(scene, first_axis, last_axis);
}

void SlicedVoxelization::mark(const gl::SceneBuffers& scene, int first_axis, int last_axis) {
  alpha_ = has_alpha(scene);
  for (int axis = first_axis; axis <= last_axis; ++axis) {
    Family& f = families_[size_t(axis)];
    f.key_low.fill(0xffffffffu);
    f.key_high.fill(0xffffffffu);
    f.blocked.clear();
    if (alpha_ && f.haze.bytes() == 0) f.haze = gl::Buffer(sizeof(std::uint32_t) * faces(voxels_.grid, axis));
    if (alpha_) f.haze.clear();
  }
  auto& program = mark_[size_t(alpha_)];
  if (!program) program = gl::Program::raster(base_name(), alpha_define(alpha_));
  program->set("footprint", kFootprintAlpha);
  raster(scene, *program, first_axis, last_axis,
         {{KEY_LOW_PLACE, &Family::key_low},
          {KEY_HIGH_PLACE, &Family::key_high},
          {BLOCKED_PLACE, &Family::blocked},
          {HAZE_PLACE, &Family::haze}});
}

/// Draws the scene once for each axis or, in a single pass, for all. Buffers are bound by their places, families
/// within.
void SlicedVoxelization::raster(const gl::SceneBuffers& scene, const gl::Program& program, int first_axis,
                                int last_axis, std::initializer_list<PlacedBuffer> buffers) {
  voxels_.grid_block.bind_uniform(GRID_BLOCK);
  program.set("triangle_bits", std::max(8, int(std::bit_width(scene.triangle_count()))));
  const int at_once = method_ == VoxelizationMethod::single_pass ? 3 : 1;
  for (int axis = first_axis; axis <= last_axis; axis += at_once) {
    for (const auto& [place, buffer] : buffers) {
      for (int family = 0; family < at_once; ++family) {
        const gl::Buffer& b = families_[size_t(axis + family)].*buffer;
        if (b.bytes() > 0) b.bind_storage(GLuint(place * at_once + family));
      }
    }
    program.set("axis", axis);
    gl::begin_fullscreen_pass();  // no depth test: all fragments count
    columns_.bind();
    scene.draw(program);
  }
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

/// How many surfaces and sides there are, as far as is known: from the run before, unless this one is to wait.
void SlicedVoxelization::count_surfaces(int first_axis, int last_axis) {
  if (counted_->pending() > 0) counted_->pop(&wanted_);
  if (!count_and_wait_) return;
  for (int axis = first_axis; axis <= last_axis; ++axis) number_surfaces(axis);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  wanted_buffer_.download(wanted_.data(), sizeof(Wanted));
}

void SlicedVoxelization::make_room_for_surfaces(int axis) {
  Family& f = families_[size_t(axis)];
  if (f.capacity > 0 && wanted_[size_t(axis)] <= f.capacity) return;
  f.capacity = with_headroom(wanted_[size_t(axis)]);
  f.surfaces = gl::Buffer(kSurfaceBytes * size_t(f.capacity));
}

void SlicedVoxelization::number_surfaces(int axis) {
  Family& f = families_[size_t(axis)];
  wanted_buffer_.fill(0, 1, size_t(axis));
  f.key_low.bind_storage(NUMBER_KEY_LOW_SLOT);
  f.entries.bind_storage(NUMBER_ENTRIES_SLOT);
  wanted_buffer_.bind_storage(WANTED_SLOT);
  number_.use();
  number_.set("axis", axis);
  number_.set("capacity", GLuint(f.capacity));
  dispatch_in_turn(faces(voxels_.grid, axis), VOXEL_GROUP);
}

void SlicedVoxelization::write_surfaces(const gl::SceneBuffers& scene, int first_axis, int last_axis) {
  write_.set("footprint", kFootprintAlbedo);
  raster(scene, write_, first_axis, last_axis,
         {{KEY_LOW_PLACE, &Family::key_low},
          {KEY_HIGH_PLACE, &Family::key_high},
          {ENTRIES_PLACE, &Family::entries},
          {SURFACES_PLACE, &Family::surfaces}});
}

void SlicedVoxelization::find_coverage() {
  voxels_.grid_block.bind_uniform(GRID_BLOCK);
  for (GLuint axis = 0; axis < 3; ++axis) families_[axis].blocked.bind_storage(COVERAGE_BLOCKED_SLOT + axis);
  coverage_.use();
  coverage_.set("has_haze", int(alpha_));
  for (int axis = 0; axis < 3; ++axis) {
    const Family& f = families_[size_t(axis)];
    (alpha_ ? f.haze : f.key_low).bind_storage(COVERAGE_HAZE_SLOT);
    f.key_low.bind_storage(COVERAGE_KEY_LOW_SLOT);
    f.coverage.bind_storage(COVERAGE_SLOT);
    coverage_.set("axis", axis);
    dispatch_shared_out(faces(voxels_.grid, axis));
  }
}

void SlicedVoxelization::list_sides() {
  for (GLuint axis = 0; axis < 3; ++axis) families_[axis].coverage.bind_storage(LIST_COVERAGE_SLOT + axis);
  voxels_.cell_sides.bind_storage(CELL_SIDES_SLOT);
  group_totals_.bind_storage(GROUP_TOTALS_SLOT);
  count_.use();
  dispatch_in_turn(cell_count(voxels_.grid), VOXEL_GROUP);
  const gl::Buffer& sides = scan_.run(group_totals_, size_t(groups_));
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glCopyNamedBufferSubData(sides.id(), wanted_buffer_.id(), 0, 3 * sizeof(std::uint32_t), sizeof(std::uint32_t));
  make_room_for_sides();
  voxels_.grid_block.bind_uniform(GRID_BLOCK);
  wanted_buffer_.bind_storage(WANTED_SLOT);
  voxels_.cell_sides.bind_storage(CELL_SIDES_SLOT);
  group_totals_.bind_storage(GROUP_TOTALS_SLOT);
  voxels_.side_count.bind_storage(SIDE_COUNT_SLOT);
  offset_.use();
  offset_.set("capacity", GLuint(voxels_.side_capacity));
  dispatch_in_turn(cell_count(voxels_.grid), VOXEL_GROUP);
}

void SlicedVoxelization::make_room_for_sides() {
  if (count_and_wait_) {
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    wanted_buffer_.download(wanted_.data(), sizeof(Wanted));
    count_and_wait_ = false;
  }
  if (voxels_.side_capacity > 0 && wanted_[3] <= voxels_.side_capacity) return;
  voxels_.side_capacity = with_headroom(wanted_[3]);
  voxels_.sides = gl::Buffer(sizeof(shared::Side) * size_t(voxels_.side_capacity));
  area_fixed_ = gl::Buffer(sizeof(std::uint32_t) * size_t(voxels_.side_capacity));
}

void SlicedVoxelization::fill_sides() {
  voxels_.bind();
  fill_.use();
  for (int axis = 0; axis < 3; ++axis) {
    const Family& f = families_[size_t(axis)];
    f.entries.bind_storage(FILL_ENTRIES_SLOT);
    f.surfaces.bind_storage(FILL_SURFACES_SLOT);
    f.coverage.bind_storage(FILL_COVERAGE_SLOT);
    fill_.set("axis", axis);
    dispatch_shared_out(faces(voxels_.grid, axis));
  }
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
}

/// Of the sides of these axes; the others keep what they had (list_sides_fill).
void SlicedVoxelization::count_area(const gl::SceneBuffers& scene, int first_axis, int last_axis) {
  area_fixed_.clear();
  voxels_.bind();
  area_fixed_.bind_storage(AREA_FIXED_SLOT);
  auto& program = side_area_[size_t(alpha_)];
  if (!program) program = gl::Program::raster("voxel/side_area", alpha_define(alpha_));
  program->set("footprint", kFootprintAlpha);
  program->set("first_axis", first_axis);
  program->set("last_axis", last_axis);
  gl::begin_fullscreen_pass();
  columns_.bind();
  scene.draw(*program);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  collect_area_.use();
  for (int axis = first_axis; axis <= last_axis; ++axis) {
    const Family& f = families_[size_t(axis)];
    f.entries.bind_storage(AREA_ENTRIES_SLOT);
    f.surfaces.bind_storage(AREA_SURFACES_SLOT);
    collect_area_.set("axis", axis);
    dispatch_in_turn(voxels_.side_capacity, LINEAR_GROUP);
  }
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
}

size_t SlicedVoxelization::bytes() const {
  size_t sum = voxels_.bytes() + wanted_buffer_.bytes() + group_totals_.bytes() + scan_.bytes() + area_fixed_.bytes();
  for (const Family& f : families_) {
    for (const gl::Buffer* b : {&f.key_low, &f.key_high, &f.blocked, &f.haze, &f.entries, &f.surfaces, &f.coverage}) {
      sum += b->bytes();
    }
  }
  return sum;
}

std::uint32_t side_capacity_for(size_t sides) { return with_headroom(std::uint32_t(sides)); }

size_t voxelization_bytes(const Grid& grid, const Scene& scene, const ExpectedSides& expected) {
  const bool alpha = std::any_of(scene.materials.begin(), scene.materials.end(),
                                 [](const Material& m) { return m.alpha_mode != AlphaMode::opaque; });
  size_t sum = 8 * cell_count(grid) + sizeof(std::uint32_t) * (cell_count(grid) / VOXEL_GROUP + 1) + sizeof(Grid);
  for (int axis = 0; axis < 3; ++axis) sum += (alpha ? 6 : 5) * sizeof(std::uint32_t) * faces(grid, axis);
  sum += kSurfaceBytes * with_headroom(std::uint32_t(expected.faces));
  return sum + size_t(side_capacity_for(expected.sides)) * (sizeof(shared::Side) + sizeof(std::uint32_t));
}

}  // namespace volgi
