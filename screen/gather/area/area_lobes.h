#pragma once
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "screen/gather/area/area_gather.h"

namespace volgi::screen {

struct AreaLobeOptions {
  bool variance = true;  // how far samples see is smoothed, and shadows made of its variance; else each is seen or not
};

/// Passes "screen/gather/area/lobe_ways", "screen/gather/area/lobe_blur" and "screen/gather/area/lobe_shade": what
/// mirrors that albedo leaves out (GBuffer::set_mirror_apart) reflect of light straight from emissive surfaces. Where
/// nine virtual lights or more lie in a pixel's lobe, Phong or GGX, by these, seen as far as AreaGather has found their
/// groups seen; else by 24 samples of the surfaces' pictures, on an even grid about the mirrored direction, each of as
/// coarse a mipmap as it is wide. A pixel of 2 x 2 asks how far six of them see; means of that and of its square, over
/// pixels of one surface, say how much of each is lit. Surfaces that are no parallelograms, or more than eight, are
/// seen by lights alone.
/// Source: Nichols 2010, §5.3.2.1 and §5.3.3.3; we depart: at all pixels of such a surface, so that no lobe is narrower
/// than what lies between two; and distances are shares of their ways, so that a free one is 1 wherever its light is.
/// Deterministic. Cost: a reflectance for each light, or a look at 24 texels, at each such pixel; 113 bytes a pixel.
class AreaLobes {
 public:
  static constexpr const char* ways_name = "screen/gather/area/lobe_ways";
  static constexpr const char* blur_name = "screen/gather/area/lobe_blur";
  static constexpr const char* name = "screen/gather/area/lobe_shade";
  /// @param phong  has_phong_lobes().
  AreaLobes(glm::ivec2 size, const AreaLobeOptions& options, bool phong);

  /// @param gbuffer  that shines. @param gather  after its run with the same lights.
  void run(const GBuffer& gbuffer, const Camera& camera, const AreaLights& lights, const AreaGather& gather,
           const AreaGather::Hidden& hidden, gl::PassTimer& timer);
  /// Emissive surfaces, or what hides them, are others.
  void scene_moved();

  const gl::Texture& radiance() const { return radiance_; }  // RGBA32F [W m^-2 sr^-1]
  /// Share of the picture's pixels whose lobe was summed by samples. Waits for the GPU; after a frame, not in one.
  double narrow_share() const;
  size_t bytes() const;

 private:
  struct Ways {
    gl::Texture parts[3];
  };
  void show_panels(const EmitterPoints& emitters);
  void find_ways(const AreaLights& lights, const AreaGather::Hidden& hidden);
  void blur(glm::ivec2 axis, const Ways& from, const Ways& to) const;
  void shade(const AreaLights& lights, const AreaGather& gather) const;
  void set_receiver(const gl::Program& program, const AreaLights& lights) const;

  glm::ivec2 size_;
  AreaLobeOptions options_;
  bool phong_;
  gl::Texture kinds_, radiance_, pictures_;
  Ways ways_, along_rows_;
  gl::Buffer panels_;
  int panel_count_ = -1;  // < 0: to be found
  glm::vec4 viewer_{0.0f};
  FaceWalkCells cells_;
  std::string hides_;  // what the next one was made for
  gl::Program find_ways_, blur_, shade_;
};

}  // namespace volgi::screen
