// Scenes without extent along an axis have one layer of cells (docs/hard-cases.md, "shape"): what `volgi export` makes
// of them.
#include <gtest/gtest.h>
#include <openvdb/openvdb.h>
#include <unistd.h>

#include <cmath>

#include "propagation/light_in/direct_light_cpu.h"
#include "tests/support/volume_scenes.h"
#include "voxel/vdb_file.h"

namespace volgi::test {
namespace {

constexpr int kCells = 16;

TEST(FlatVolume, IsExportedLikeAnyOther) {
  for (int axis = 0; axis < 3; ++axis) {
    const Scene scene = square_across(axis);
    for (Scheme scheme : {Scheme::ordinates, Scheme::conservative}) {
      VolumeOptions options;
      options.grid_cells = kCells;
      options.scheme.scheme = scheme;
      VolumeCpu volume(scene, options);
      run_with_direct_light(volume, scene);
      const Grid& grid = volume.grid();
      EXPECT_EQ(grid.cells[axis], 1);
      EXPECT_EQ(cell_count(grid), size_t(kCells * kCells));
      // The square fills every cell, which sees it on one face: the other would be outside of the grid.
      EXPECT_EQ(volume.cells().occupancy->activeVoxelCount(), cell_count(grid));
      EXPECT_EQ(volume.voxels().side_count(), cell_count(grid));
      double sent = 0.0, returned = 0.0;
      for (size_t i = 0; i < volume.voxels().side_count(); ++i) {
        sent += double(volume.flux().punctual[i].x);
        returned += double(volume.irradiance().indirect[i].x * volume.voxels().sides()[i].area_m2);
      }
      // 4 m^2 of a square seen from 1 m above its middle: a sixth of the sphere, by a cube around the lamp.
      EXPECT_NEAR(sent, 0.8 * 3.0 * 4.0 * M_PI / 6.0, 0.02 * sent);
      // A plane does not light itself, but the lobes of `conservative` widen as they go: 8 % come back, where there are
      // 16 layers 14 % (order 2: 4 and 5 %).
      EXPECT_LE(returned, scheme == Scheme::ordinates ? 0.0 : 0.1 * sent) << axis;
      const openvdb::Vec3SGrid::Ptr light = fluence(volume.radiance());
      const std::filesystem::path file =
          std::filesystem::temp_directory_path() / ("volgi_flat_" + std::to_string(::getpid()) + ".vdb");
      write_vdb(file, {volume.cells().occupancy, light}, {});
      const VdbFile read = read_vdb(file);
      std::filesystem::remove(file);
      ASSERT_EQ(read.grids.size(), 2u);
      EXPECT_EQ(read.grids[0]->activeVoxelCount(), cell_count(grid));
      EXPECT_GT(light->activeVoxelCount(), 0u);
      EXPECT_EQ(read.grids[1]->activeVoxelCount(), light->activeVoxelCount());
      for (auto value = light->cbeginValueOn(); value; ++value) {
        ASSERT_TRUE(std::isfinite((*value)[0]));
        ASSERT_GE((*value)[0], 0.0f);
      }
    }
  }
}

}  // namespace
}  // namespace volgi::test
