#pragma once
#include "core/camera.h"
#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "screen/base/virtual_light_list_gl.h"
#include "screen/views/instances.h"
#include "screen/visibility/area_maps/virtual_area_lights.h"
#include "screen/visibility/negative/negative_lights.h"
#include "shaders/screen/views/view_modes.shared.h"

namespace volgi::screen {

/// Pass "screen/views/lights_view": a frame's virtual lights over its picture, as disks of an area in proportion to
/// their flux (mean of the bands), with a short line along their normals; negative lights as blue rings; area lights as
/// squares, in the colours of Mode::cluster. Lights without flux are not drawn. Cost: a sum over the lights; a square,
/// a line and their texels a light.
class LightsView {
 public:
  static constexpr const char* name = "screen/views/lights_view";
  enum class Mode {
    flux = VIEW_LIGHT_FLUX,        // the flux's own hue
    source = VIEW_LIGHT_SOURCE,    // a colour for each lamp; pale yellow for emissive surfaces
    cluster = VIEW_LIGHT_CLUSTER,  // a colour for each area light; needs Shown::area_lights, else as flux
  };
  /// What a frame has made, Frame::products(); null: none, or not to be shown.
  struct Shown {
    const VirtualLightListGl* lights = nullptr;
    const NegativeLights* negative = nullptr;
    const VirtualAreaLights* area_lights = nullptr;  // of `lights`
  };
  struct Options {
    Mode mode = Mode::flux;
    float share = 0.02f;           // of the picture, for all virtual lights together, did they not hide each other
    float least_radius_px = 1.5f;  // of a light that has flux
    float tick_px = 8.0f;          // length across the view; 0: none
    bool squares = true;           // of Shown::area_lights
  };
  LightsView();
  /// Disks of negative lights are on the scale of `lights`; on their own where there are none.
  /// @param camera  of the picture. @param target  with the depth that hides lights (ViewTarget::begin_overlays).
  void run(const Shown& shown, const Camera& camera, const Options& options, const gl::Framebuffer& target,
           gl::PassTimer& timer);

 private:
  void sum_flux(const gl::Buffer& lights, int count);
  void draw_lights(const gl::Buffer& lights, int count, const gl::Buffer* cluster_of, bool negative,
                   const Options& options);

  gl::Program total_, disks_, ticks_, squares_;
  Instances lights_;
  gl::Buffer total_flux_;
};

}  // namespace volgi::screen
