#pragma once
#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "screen/base/gbuffer.h"
#include "screen/base/sum_in_order.h"
#include "screen/base/virtual_light_list_gl.h"

namespace volgi::screen {

/// Pass "screen/lights/resample/resample_virtual_lights": of many candidates the ones that matter to the picture. A
/// candidate's weight is the light that it sends, without visibility, to 256 pixels of a Halton sequence, and
/// kFluxShare of all weight goes by flux alone: nothing that carries light is left out, and no light carries more than
/// 1 / kFluxShare of an even share. Each source keeps its number of lights, chosen by systematic resampling (equal
/// steps through the summed weights): a light chosen with probability p carries 1/p of its flux and area, and any sum
/// over lights keeps its mean. One that is chosen k times carries a part of its flux each time, but all of its area:
/// its copies lie in one place, and k disks of a k-th of the area would be k times as bright nearby. Lights that face
/// out of the scene, such as the sun's on a roof over the room that is seen, all but vanish. Cost: candidates times
/// 256. Depends on the camera.
class ResampleVirtualLights {
 public:
  static constexpr const char* name = "screen/lights/resample/resample_virtual_lights";
  static constexpr float kFluxShare = 0.1f;
  /// @param candidates_per_light that each light is resampled from.
  explicit ResampleVirtualLights(int candidates_per_light);

  /// @param sample  FrameData::sample: other pixels, and steps that begin elsewhere.
  void run(const VirtualLightListGl& candidates, const GBuffer& gbuffer, gl::PassTimer& timer, int sample = 0);

  const VirtualLightListGl& lights() const { return lights_; }
  /// vec2 for each light: the range [x, y) of its source's candidates that it stands for, counted from 0 and in parts
  /// of one. Ranges follow on one another, without gap or overlap; the last one may go on at the first candidate, whose
  /// place is then the number of candidates.
  const gl::Buffer& ranges() const { return ranges_; }
  int candidates_per_light() const { return candidates_per_light_; }
  size_t bytes() const { return lights_.buffer.bytes() + receivers_.bytes() + weights_.bytes() + ranges_.bytes(); }

 private:
  void make_room(const VirtualLightListGl& candidates);
  void resample(int first_candidate, int candidates, int first, int count);

  int candidates_per_light_;
  VirtualLightListGl lights_;
  gl::Buffer receivers_, weights_, ranges_;
  gl::Program receivers_program_, weigh_, resample_;
  SumInOrder sum_;
};

}  // namespace volgi::screen
