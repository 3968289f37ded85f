#pragma once
#include <optional>
#include <span>
#include <vector>

#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "screen/base/gbuffer.h"
#include "screen/base/named_texture.h"
#include "screen/base/work_list.h"

namespace volgi::screen {

/// Light that changes smoothly over most of a surface, so that not all pixels need be gathered for it (SmoothPixels).
class SmoothLight {
 public:
  virtual ~SmoothLight() = default;
  /// Its pictures in this frame, RGBA32F [W m^-2 sr^-1]; at most SMOOTH_PICTURES of all lights together.
  virtual std::vector<const gl::Texture*> radiance() const = 0;
  /// Gathers the pixels of `list`. The G-buffer is bound.
  /// @param step_px  of the grid that they are new on: those of 2 and 1 are many, and lie at edges.
  /// @param irradiance  RGBA32F [W m^-2], one for each of radiance(): where to.
  virtual void gather(const WorkList& list, int step_px, std::span<const gl::Texture> irradiance,
                      gl::PassTimer& timer) = 0;
};

struct SmoothPixelOptions {
  int coarsest = 16;        // pixels between those that are always gathered: 1, 2, 4, 8, 16 or 32; 1: every pixel
  float tolerance = 0.03f;  // of a pixel's irradiance, that what its neighbours say may err by
  float min_cosine = 0.8f;  // neighbours show one surface whose normals have at least this cosine, ...
  float off_plane = 0.2f;   // ... and which lie on one another's tangent plane, to this sine of the way's angle
};

/// Pass "screen/base/smooth_pixels": which pixels smooth light is gathered at, and what the others have. From a grid of
/// every 16th pixel on, each finer one takes what its neighbours say where four in a row show one surface and their
/// light varies as a cubic does, and is gathered otherwise: where depth, normals or light change. After Nichols 2010,
/// §3.2 and §5.3.4, whose subsplats are refined coarse to fine; we depart: pixels instead of subsplats, so that what is
/// interpolated needs no upsampling and has no halo; and light itself decides, all lights together. Lists are made and
/// worked off by the GPU. Deterministic: no pixel depends on the order of a list.
/// Cost: a gather for each pixel that needs it, where all is edges every one; up to eight look-ups for each other one.
class SmoothPixels {
 public:
  static constexpr const char* name = "screen/base/smooth_pixels";
  /// @throws Error(usage) when an option is none of its values, or not finite.
  static void check(const SmoothPixelOptions& options);
  SmoothPixels(glm::ivec2 size, const SmoothPixelOptions& options);

  void run(const GBuffer& gbuffer, std::span<SmoothLight* const> lights, gl::PassTimer& timer);

  /// R8UI: of the grid on which a pixel was gathered [pixels], 0 where neighbours said enough.
  const gl::Texture& gathered_step() const { return gathered_step_; }
  void list_textures(std::vector<NamedTexture>& list) const;
  /// Share of the pixels that were gathered. Waits for the GPU; after a frame, not in one.
  double gathered_share() const;
  size_t bytes() const;

 private:
  struct Programs {
    gl::Program first, along, between, last_along, last_between, mean, shade;
  };
  const Programs& programs_for(size_t pictures);
  void make_room(size_t pictures);
  void bind(size_t pictures) const;
  void refine(const Programs& programs, int step_px, const WorkList& list);
  void dispatch(const gl::Program& program, int step_px, int every, glm::ivec2 odd) const;
  void find_mean(const gl::Program& program);
  void shade(const gl::Program& program, const std::vector<const gl::Texture*>& radiance) const;

  SmoothPixelOptions options_;
  glm::ivec2 size_;
  std::vector<WorkList> lists_;          // of each step, the coarsest first
  std::vector<gl::Texture> irradiance_;  // of each picture, one light's after the other's
  gl::Texture gathered_step_;
  gl::Buffer mean_;
  std::vector<std::optional<Programs>> programs_;  // by the number of pictures
};

/// Stages that gather smooth light meet here: those of one frame are gathered together, by the last of them.
struct SmoothGather {
  static constexpr const char* product_name = "smooth light's pixels";
  SmoothPixels& pixels;
  SmoothLight& first;  // of the stage that lends this
};

}  // namespace volgi::screen
