#pragma once
#include <string>
#include <vector>

#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "screen/base/gbuffer.h"
#include "screen/base/named_texture.h"
#include "screen/base/work_list.h"
#include "screen/sources/textured_area/area_lights.h"
#include "screen/visibility/screen_voxels/screen_voxels.h"
#include "screen/visibility/screen_voxels/screen_voxels_stage.h"
#include "voxel/face_walk_gl.h"

namespace volgi::screen {

struct AreaGatherOptions {
  int coarsest = 16;        // pixels between those that are always gathered: 1, 2, 4, 8, 16 or 32
  float tolerance = 0.05f;  // of irradiance, between neighbours, above which what lies between them is gathered
  float in_part = 0.5f;     // share of the lights whose visibility may differ there
  bool incremental = true;  // lights that all neighbours see, or none does, are not asked again
};

/// Passes "screen/gather/area/gather" and "screen/gather/area/shade": light straight from emissive surfaces, of at most
/// 256 virtual lights on them, at pixels coarse to fine: a level's pixels are gathered where its surface has an edge,
/// or where light or visibility vary between those of the level before; the others are interpolated. Each pixel keeps a
/// bit for every light, so that a finer one asks only for those on which its neighbours disagree.
/// Source: Nichols 2010, §5.3.2 to §5.3.4; we depart: pixels instead of patches, as in screen/base/smooth_pixels.h, so
/// that nothing is upsampled; a level's own variation is what its neighbours show, so masks need no stencil buffer;
/// and every pixel has all bits, where the thesis shares them out to blocks of 2 x 2.
/// Deterministic. Cost: a form factor for each light at each gathered pixel, a way for those that are asked;
/// 48 bytes a pixel.
class AreaGather {
 public:
  static constexpr const char* name = "screen/gather/area/gather";
  static constexpr const char* shade_name = "screen/gather/area/shade";
  /// @throws Error(usage) when options.coarsest is none of its values.
  static void check(const AreaGatherOptions& options);
  AreaGather(glm::ivec2 size, const AreaGatherOptions& options);

  /// What hides lights: one of them, or neither.
  struct Hidden {
    const ScreenVoxels* voxels;
    const BlockedFaces* faces;
  };
  /// @param lights  at most 256.
  void run(const GBuffer& gbuffer, const AreaLights& lights, const Hidden& hidden, gl::PassTimer& timer);
  /// The faces of the next run are others.
  void scene_moved() { cells_.forget(); }

  const gl::Texture& radiance() const { return radiance_; }  // RGBA32F [W m^-2 sr^-1]
  /// R8UI: of the level on which a pixel was gathered [pixels], 0 where it was interpolated.
  const gl::Texture& gathered_step() const { return gathered_step_; }
  struct Figures {
    double gathered;            // share of the pixels
    double asked;               // ways that were asked, of those of gathered pixels
    std::vector<double> level;  // gathered pixels, the coarsest level first, of those that it has
    double ways;                // that were asked
  };
  /// Waits for the GPU; after a frame, not in one.
  Figures figures() const;
  size_t bytes() const;
  void list_textures(std::vector<NamedTexture>& list) const {
    list_texture(list, name, "step", gathered_step_);
    list_texture(list, name, "irradiance", irradiance_);
    list_texture(list, shade_name, "", radiance_);
  }

 private:
  void refine(int step_px, const WorkList& list);
  void gather(int step_px, const AreaLights& lights, const Hidden& hidden, const WorkList& list);
  void bind_pictures() const;
  const gl::Program& gather_program(bool first, const Hidden& hidden);

  glm::ivec2 size_;
  AreaGatherOptions options_;
  std::vector<WorkList> lists_;  // of each level, the coarsest first
  gl::Texture irradiance_, masks_[2], gathered_step_, radiance_;
  gl::Buffer counts_;
  FaceWalkCells cells_;
  gl::Program first_, finer_, shade_;
  std::string hides_;  // what the next two were made for
  gl::Program gather_first_, gather_finer_;
};

}  // namespace volgi::screen
