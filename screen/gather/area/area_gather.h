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
#include "screen/visibility/host_rays/host_rays.h"
#include "screen/visibility/screen_voxels/screen_voxels.h"
#include "screen/visibility/screen_voxels/screen_voxels_stage.h"
#include "voxel/face_walk_gl.h"

namespace volgi::screen {

struct AreaGatherOptions {
  int coarsest = 16;        // pixels between those that are always gathered: 1, 2, 4, 8, 16 or 32
  float tolerance = 0.05f;  // of irradiance, between neighbours, above which what lies between them is gathered
  float in_part = 0.5f;     // share of the lights whose visibility may differ there
  bool incremental = true;  // lights that all neighbours see, or none does, are not asked again
  int interleave = 4;       // levels of so many pixels or fewer between neighbours share ways out; 0: none
};

/// Passes "screen/gather/area/gather_N", N the pixels between neighbours of a level, and "screen/gather/area/shade":
/// light straight from emissive surfaces by virtual lights on them, at pixels coarse to fine: a level's pixels are
/// gathered where its surface has an edge, or where light or visibility vary between those of the level before; the
/// others are interpolated. Lights that follow on one another are one of 64 groups. Each pixel keeps two bits for every
/// group, whether some and whether all of its lights are seen, so that a finer one asks only for groups on which its
/// neighbours disagree. On fine levels a pixel asks for a quarter of the lights, each of which counts for the four
/// around it, as pixels around it ask for the other ones; on the finest it then takes the mean of them. Source: Nichols
/// 2010, §5.3.2 to §5.3.4; we depart: pixels instead of patches, as in screen/base/smooth_pixels.h, so that nothing is
/// upsampled; a level's own variation is what its neighbours show, so masks need no stencil buffer; bits are of groups,
/// so that more than 256 lights take no more of them; and pixels share visibility out, not light, on levels of
/// `interleave` and finer, as coarse ones are few and far apart. Deterministic. Cost: a form factor for each light at
/// each gathered pixel, a way for those that are asked; 65 bytes a pixel.
class AreaGather {
 public:
  static constexpr const char* name = "screen/gather/area/gather";
  static std::string level_name(int step_px);  // of its pass
  static constexpr const char* shade_name = "screen/gather/area/shade";
  /// @throws Error(usage) when options.coarsest is none of its values.
  static void check(const AreaGatherOptions& options);
  AreaGather(glm::ivec2 size, const AreaGatherOptions& options);

  /// What hides lights: rays before the others; null: they are not there.
  struct Hidden {
    const ScreenVoxels* voxels = nullptr;
    const BlockedFaces* faces = nullptr;
    const HostRays* rays = nullptr;
  };
  void run(const GBuffer& gbuffer, const AreaLights& lights, const Hidden& hidden, gl::PassTimer& timer);
  /// The faces of the next run are others.
  void scene_moved() { cells_.forget(); }

  static int lights_in_group(int lights);                    // bits of masks() are of so many each
  const gl::Texture& masks() const { return masks_; }        // RGBA32UI: known_mask of area_level.glsl
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
  /// Pixels of a level that have the same share of each group's lights, or all of them.
  struct Level {
    int step_px;
    std::vector<WorkList> lists;
  };
  void refine(const Level& level, int groups);
  void gather(const Level& level, const AreaLights& lights, const Hidden& hidden);
  struct Part;
  void ask(const WorkList& list, const Part& part, const HostRays& rays);
  void join(const Level& level);
  void bind_pictures() const;
  const gl::Program& gather_program(bool first, const Hidden& hidden);

  glm::ivec2 size_;
  AreaGatherOptions options_;
  std::vector<Level> levels_;  // the coarsest first
  gl::Texture irradiance_, shared_irradiance_, masks_, gathered_step_, radiance_;
  gl::Buffer counts_;
  gl::Buffer questions_, askers_;             // of HostRays
  std::vector<shared::VirtualLight> lights_;  // on the host, for them
  FaceWalkCells cells_;
  gl::Program first_, finer_, join_, shade_;
  std::string hides_;  // what the next two were made for
  gl::Program gather_first_, gather_finer_, ask_first_, ask_finer_;
};

}  // namespace volgi::screen
