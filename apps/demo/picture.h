#pragma once
#include <optional>
#include <string>

#include "apps/demo/settings.h"
#include "apps/demo/view.h"
#include "core/image.h"
#include "screen/display/accumulate.h"
#include "screen/display/exposure_meter.h"
#include "screen/display/fxaa.h"
#include "screen/display/present.h"
#include "screen/frame/frame.h"
#include "screen/views/error_view.h"
#include "screen/views/gbuffer_view.h"
#include "screen/views/light_tree_level.h"
#include "screen/views/lights_view.h"
#include "screen/views/lobe_view.h"
#include "screen/views/texture_view.h"
#include "screen/views/view_target.h"
#include "screen/views/voxel_view.h"
#include "screen/views/wipe.h"

namespace volgi::demo {

/// Choices within a view; not kept between runs.
struct ViewDetails {
  std::string texture;  // by its name; empty: the first
  int layer = 0;        // of an array, a slice, a cluster, or a level of the light tree
  int channel = 0;      // screen::TextureView's
  bool log_scale = false;
  std::optional<glm::vec2> range;    // none: by what is there
  int voxel_colour = 0;              // screen::VoxelView's
  int light_colour = 0;              // screen::LightsView's
  float dim = 0.5f;                  // of the picture behind what is drawn over it
  std::optional<glm::vec3> lobe_at;  // in the centred frame; none: the middle of the scene
  bool operator==(const ViewDetails&) const = default;
};

/// Pixels from a frame's radiance to what a window shows: the average while nothing moves, exposure, tone map, filter,
/// and the views.
class Picture {
 public:
  explicit Picture(glm::ivec2 size);

  /// The next add() begins a new average.
  void restart() { accumulate_.reset(); }
  void add(const gl::Texture& radiance, gl::PassTimer& timer);
  int samples() const { return accumulate_.count(); }
  /// RGBA32F, the mean so far [W m^-2 sr^-1].
  const gl::Texture& radiance() const { return accumulate_.mean(); }
  /// On the CPU, as write_exr() and write_png() take it. Waits for the GPU.
  Image image() const;

  /// Given, or as bright as ExposureMeter finds it.
  float exposure_ev(std::optional<double> given) const { return given ? float(*given) : automatic_ev_; }
  /// Automatic exposure follows the light within half a second; at once after settle_exposure().
  /// @param wait  for what the meter has under way: the same whatever the GPU's pace.
  void adapt(double seconds, bool wait = false);
  void settle_exposure();
  /// Goes on from another picture's.
  void take_exposure(const Picture& other);

  /// Draws a view into display(). @param scene, camera  that the frame was rendered for.
  void show(const screen::Frame& frame, const Scene& scene, const Camera& camera, const ViewDetails& details,
            const Settings& settings, gl::PassTimer& timer);
  /// Once for each reference that show_truth() is given. Waits for the GPU: between frames.
  void new_truth(const gl::Texture& reference);
  /// A reference over what show() drew: right of `wipe` of the width, or the signed difference from it.
  /// @param reference  RGBA32F of the picture's size.
  void show_truth(const gl::Texture& reference, bool error, float wipe, float exposure_ev, gl::PassTimer& timer);
  /// What is under a pixel (y down) of a view that shows a texture, in words; empty where there is nothing. Waits for
  /// the GPU: between frames.
  std::string under(glm::vec2 pixel) const;
  const gl::Texture& display() const { return *shown_; }  // RGBA8, sRGB encoded, row 0 at the bottom
  glm::ivec2 size() const { return size_; }

 private:
  void show_light(const Settings& settings, gl::PassTimer& timer);
  void show_gbuffer(const screen::Frame& frame, const Scene& scene, const Camera& camera,
                    screen::GBufferView::Mode mode, const Settings& settings, gl::PassTimer& timer);
  void begin_overlays(const screen::ViewTarget::Overlays& overlays, const Camera& camera, gl::PassTimer& timer);
  void show_sides(const screen::Frame& frame, const Camera& camera, screen::VoxelView::Mode mode,
                  const ViewDetails& details, const Settings& settings, gl::PassTimer& timer);
  void show_lobe(const screen::Frame& frame, const Scene& scene, const Camera& camera, const ViewDetails& details,
                 const Settings& settings, gl::PassTimer& timer);
  void show_lights(const screen::Frame& frame, const Camera& camera, View view, const ViewDetails& details,
                   const Settings& settings, gl::PassTimer& timer);
  void show_named(const screen::Frame& frame, std::string_view name, const ViewDetails& details,
                  const Settings& settings, gl::PassTimer& timer);
  void show_texture(const screen::NamedTexture& texture, const ViewDetails& details, gl::PassTimer& timer);
  glm::vec2 range_of(const screen::NamedTexture& texture, const ViewDetails& details);

  glm::ivec2 size_;
  screen::Accumulate accumulate_;
  screen::ExposureMeter meter_;
  screen::Present present_;
  screen::Fxaa fxaa_;
  screen::ViewTarget target_;
  gl::Texture filtered_;  // RGBA8
  gl::Framebuffer filtered_target_;
  const gl::Texture* shown_ = nullptr;
  screen::GBufferView gbuffer_view_;
  screen::TextureView texture_view_;
  screen::VoxelView voxel_view_;
  screen::LobeView lobe_view_;
  screen::LightsView lights_view_;
  screen::LightTreeLevel light_tree_level_;
  screen::ErrorView error_view_;
  screen::Wipe wipe_;
  float error_floor_ = 0.0f;  // of the reference that was shown last
  // The texture that is shown, and the range that was found for it.
  const gl::Texture* texture_ = nullptr;
  int texture_layer_ = 0;
  std::string range_key_;
  glm::vec2 range_{0.0f, 1.0f};
  int shows_since_range_ = 0;
  float automatic_ev_ = 0.0f;
  bool metered_ = false;
};

}  // namespace volgi::demo
