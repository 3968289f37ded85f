#pragma once

namespace volgi {

/// How the scene meets the lattice: `sliced`, once along each axis; `single_pass`, every triangle once along the axis
/// nearest to its normal, where a fragment finds the crossings of all three families. Both find the same (tests).
enum class VoxelizationMethod { sliced, single_pass };

/// Of the GPU's voxelization (voxel/sliced_voxelization.h).
struct VoxelizationOptions {
  VoxelizationMethod method = VoxelizationMethod::sliced;
  /// Every run slices along one axis only, x, y and z in turn, and keeps what earlier runs have found along the others
  /// (Gaitatzes 2010, section 5.1), the areas of their sides included: what moves lags by up to two runs. Three runs of
  /// a scene at rest find the sides that a full one does; their areas, which are shared out among the sides that there
  /// are, take three more. The first run is a full one. Not with single_pass.
  bool interleave = false;
};

}  // namespace volgi
