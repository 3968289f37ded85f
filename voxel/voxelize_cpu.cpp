#include "voxel/voxelize_cpu.h"

#include "voxel/slice_internal.h"

namespace volgi {

namespace {

VoxelGrid voxelize(const slicing::SlicedScene& s) {
  slicing::BlockTable table = slicing::mark_faces(s);
  slicing::cover_faces(s, table);
  VoxelGrid voxels = slicing::make_sides(s, table);
  slicing::count_areas(s, table, voxels);
  return voxels;
}

}  // namespace

VoxelGrid voxelize_cpu(const Scene& scene, const Grid& grid) { return voxelize(slicing::slice_scene(scene, grid)); }

CellVolumes cell_volumes_cpu(const Scene& scene, const Grid& grid) {
  return slicing::make_cell_volumes(slicing::slice_scene(scene, grid));
}

Voxelized voxelize_all_cpu(const Scene& scene, const Grid& grid) {
  const slicing::SlicedScene s = slicing::slice_scene(scene, grid);
  return {voxelize(s), slicing::make_cell_volumes(s)};
}

}  // namespace volgi
