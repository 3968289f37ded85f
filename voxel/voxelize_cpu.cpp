#include "voxel/voxelize_cpu.h"

#include "voxel/slice_internal.h"

namespace volgi {

namespace {

VoxelGrid make_voxels(const slicing::SlicedScene& s, slicing::BlockTable& table) {
  slicing::cover_faces(s, table);
  VoxelGrid voxels = slicing::make_sides(s, table);
  slicing::set_areas(slicing::count_areas(s, table, voxels), voxels);
  return voxels;
}

}  // namespace

Mipmaps voxelization_mipmaps(const Scene& scene) {
  Mipmaps mipmaps(scene);
  for (const Material& m : scene.materials) {
    if (m.base_color.texture >= 0) mipmaps.prepare(m.base_color.texture, true);
    if (m.metallic.texture >= 0) mipmaps.prepare(m.metallic.texture, false);
    if (m.emissive.texture >= 0) mipmaps.prepare(m.emissive.texture, true);
  }
  return mipmaps;
}

VoxelGrid voxelize_cpu(const Scene& scene, const Grid& grid, const Mipmaps& mipmaps) {
  const slicing::SlicedScene s = slicing::slice_scene(scene, grid, mipmaps);
  slicing::BlockTable table = slicing::mark_faces(s);
  return make_voxels(s, table);
}

VoxelGrid voxelize_cpu(const Scene& scene, const Grid& grid, const Mipmaps& mipmaps, const RanksOfVolume& ranks) {
  const slicing::SlicedScene s = slicing::slice_scene(scene, grid, mipmaps, ranks.part());
  slicing::BlockTable table = slicing::mark_faces(s);
  slicing::cover_faces(s, table);
  VoxelGrid voxels = slicing::make_sides(s, table);
  std::vector<std::uint32_t> areas = slicing::count_areas(s, table, voxels);
  // A side's surface may lie in several parts.
  const SideHalo halo(ranks, voxels);
  halo.add_up(areas);
  halo.fetch(areas);
  slicing::set_areas(areas, voxels);
  return voxels;
}

CellVolumes cell_volumes_cpu(const Scene& scene, const Grid& grid, const Mipmaps& mipmaps, const BlockBox& part) {
  const slicing::SlicedScene s = slicing::slice_scene(scene, grid, mipmaps, part);
  return slicing::make_cell_volumes(s, slicing::list_areas(s));
}

CellVolumes cell_volumes_cpu(const Scene& scene, const Grid& grid, const Mipmaps& mipmaps) {
  return cell_volumes_cpu(scene, grid, mipmaps, {glm::ivec3(0), leaf_blocks(grid)});
}

Voxelized voxelize_all_cpu(const Scene& scene, const Grid& grid, const Mipmaps& mipmaps) {
  const slicing::SlicedScene s = slicing::slice_scene(scene, grid, mipmaps);
  slicing::BlockTable table = slicing::mark_faces(s);
  return {make_voxels(s, table), slicing::make_cell_volumes(s, table)};
}

VoxelGrid voxelize_cpu(const Scene& scene, const Grid& grid) {
  return voxelize_cpu(scene, grid, voxelization_mipmaps(scene));
}

CellVolumes cell_volumes_cpu(const Scene& scene, const Grid& grid) {
  return cell_volumes_cpu(scene, grid, voxelization_mipmaps(scene));
}

Voxelized voxelize_all_cpu(const Scene& scene, const Grid& grid) {
  return voxelize_all_cpu(scene, grid, voxelization_mipmaps(scene));
}

}  // namespace volgi
