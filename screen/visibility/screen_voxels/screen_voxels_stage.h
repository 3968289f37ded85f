#pragma once
#include "screen/base/frame_voxels.h"
#include "screen/frame/stage.h"

namespace volgi::screen {

/// What hides lights on emissive surfaces: voxels of the camera's frustum (screen_voxels.h), the volume's blocked
/// faces, which know what the camera does not see but no detail below a cell, or rays of the CPU (host_rays.h), and
/// faces for lobes then. Makes ScreenVoxels, BlockedFaces or HostRays.
extern const StageType SCREEN_VOXELS;

/// The volume's blocked faces, for rays (shaders/voxel/face_walk.glsl).
struct BlockedFaces {
  static constexpr const char* product_name = "blocked faces";
  const VoxelGridGl& voxels;
};

}  // namespace volgi::screen
