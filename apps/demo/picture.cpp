#include "apps/demo/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "screen/base/image_from_texture.h"
#include "screen/bounces/volume/frame_volume.h"
#include "screen/visibility/area_maps/light_clusters.h"
#include "screen/visibility/negative/negative_lights.h"

namespace volgi::demo {

namespace {

/// Of ViewDetails::channel.
constexpr std::array CHANNELS = {VIEW_RGB, VIEW_RED, VIEW_GREEN, VIEW_BLUE, VIEW_ALPHA, VIEW_LENGTH};

/// Of ViewDetails::voxel_colour.
constexpr std::array SIDE_COLOURS = {screen::VoxelView::Mode::irradiance, screen::VoxelView::Mode::direct,
                                     screen::VoxelView::Mode::indirect,   screen::VoxelView::Mode::albedo,
                                     screen::VoxelView::Mode::coverage,   screen::VoxelView::Mode::normal,
                                     screen::VoxelView::Mode::emission};

gl::Framebuffer over(const gl::Texture& texture, glm::ivec2 size) {
  const gl::Framebuffer::Attachment colour{&texture, -1};
  return {std::span(&colour, 1), {}, size};
}

}  // namespace

Picture::Picture(glm::ivec2 size)
    : size_(size),
      accumulate_(size),
      target_(size),
      filtered_(gl::Texture::make_2d(GL_RGBA8, size.x, size.y)),
      filtered_target_(over(filtered_, size)),
      shown_(&target_.picture()) {}

void Picture::add(const gl::Texture& radiance, gl::PassTimer& timer) {
  accumulate_.add(radiance, timer);
  meter_.run(accumulate_.mean(), timer);
}

Image Picture::image() const { return screen::image_from_texture(accumulate_.mean()); }

void Picture::adapt(double seconds, bool wait) {
  constexpr double ADAPTATION_S = 0.2;
  const std::optional<float> ev = wait ? meter_.wait() : meter_.exposure_ev();
  if (!ev) return;
  const float share = metered_ ? float(1.0 - std::exp(-seconds / ADAPTATION_S)) : 1.0f;
  automatic_ev_ += share * (*ev - automatic_ev_);
  metered_ = true;
}

void Picture::take_exposure(const Picture& other) {
  automatic_ev_ = other.automatic_ev_;
  metered_ = other.metered_;
}

void Picture::settle_exposure() {
  if (const std::optional<float> ev = meter_.wait()) {
    automatic_ev_ = *ev;
    metered_ = true;
  }
}

void Picture::show_light(const Settings& settings, gl::PassTimer& timer) {
  present_.run(radiance(), exposure_ev(settings.exposure_ev), target_.framebuffer(), timer);
  // Averaged pixels need no filter.
  constexpr int ENOUGH_SAMPLES = 4;
  if (!settings.post_filter || samples() >= ENOUGH_SAMPLES) return;
  fxaa_.run(target_.picture(), filtered_target_, timer);
  shown_ = &filtered_;
}

namespace {

/// Along the camera's axis, of the scene's box in front of it.
glm::vec2 depth_range_m(const Scene& scene, const Camera& camera) {
  const glm::mat4 from_world = camera_from_world(camera);
  glm::vec2 range(std::numeric_limits<float>::max(), 0.0f);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 upper(corner & 1, corner >> 1 & 1, corner >> 2);
    const float depth = -(from_world * glm::vec4(glm::mix(scene.bounds_min, scene.bounds_max, upper), 1.0f)).z;
    range = {std::min(range.x, depth), std::max(range.y, depth)};
  }
  range.x = std::max(range.x, 0.0f);
  return range.x < range.y ? range : glm::vec2(0.0f, camera.zfar);
}

}  // namespace

void Picture::show_gbuffer(const screen::Frame& frame, const Scene& scene, const Camera& camera,
                           screen::GBufferView::Mode mode, const Settings& settings, gl::PassTimer& timer) {
  gbuffer_view_.run(frame.gbuffer(), camera, {mode, depth_range_m(scene, camera), exposure_ev(settings.exposure_ev)},
                    target_.framebuffer(), timer);
}

/// Found anew for another texture, and now and then.
glm::vec2 Picture::range_of(const screen::NamedTexture& texture, const ViewDetails& details) {
  if (details.range) return *details.range;
  constexpr int SHOWS_BETWEEN = 30;
  const std::string key = fmt::format("{} {} {} {}", texture.name, details.layer, details.channel, details.log_scale);
  if (key != range_key_ || ++shows_since_range_ >= SHOWS_BETWEEN) {
    range_ =
        screen::automatic_range(*texture.texture, details.layer,
                                screen::TextureView::Channel(CHANNELS[size_t(details.channel)]), details.log_scale);
    range_key_ = key;
    shows_since_range_ = 0;
  }
  return range_;
}

void Picture::show_texture(const screen::NamedTexture& texture, const ViewDetails& details, gl::PassTimer& timer) {
  screen::TextureView::Options options;
  options.layer = details.layer;
  options.range = range_of(texture, details);
  options.log_scale = details.log_scale;
  options.channel = screen::TextureView::Channel(CHANNELS[size_t(details.channel)]);
  options.encode = texture.name.find("normal") == std::string::npos;
  texture_view_.run(*texture.texture, options, target_.framebuffer(), timer);
  texture_ = texture.texture;
  texture_layer_ = details.layer;
}

namespace {

/// By its name; else the one whose name has the words in it; else the first.
constexpr const char* SMOOTH_STEP = "smooth_pixels step";

const screen::NamedTexture* find_texture(const std::vector<screen::NamedTexture>& all, std::string_view name) {
  const screen::NamedTexture* found = nullptr;
  for (const screen::NamedTexture& t : all) {
    if (t.name == name) return &t;
    if (found == nullptr && t.name.find(name) != std::string::npos) found = &t;
  }
  return found;
}

}  // namespace

void Picture::show_named(const screen::Frame& frame, std::string_view name, const ViewDetails& details,
                         const Settings& settings, gl::PassTimer& timer) {
  const std::vector<screen::NamedTexture> all = frame.textures();
  if (const screen::NamedTexture* texture = find_texture(all, name)) {
    show_texture(*texture, details, timer);
  } else {
    show_light(settings, timer);
  }
}

namespace {
float sides_slack_m(const screen::FrameVolume& volume) {
  return screen::ViewTarget::SIDES_SLACK_CELLS * volume.voxels().grid.cell_size_m;
}
}  // namespace

/// Over the picture as it was before the filter, which would smooth marks as well.
void Picture::begin_overlays(const screen::ViewTarget::Overlays& overlays, const Camera& camera, gl::PassTimer& timer) {
  shown_ = &target_.picture();
  target_.begin_overlays(overlays, camera, timer);
}

void Picture::show_sides(const screen::Frame& frame, const Camera& camera, screen::VoxelView::Mode mode,
                         const ViewDetails& details, const Settings& settings, gl::PassTimer& timer) {
  const auto* volume = frame.products().find<screen::FrameVolume>();
  if (volume == nullptr || !volume->sides_on_gpu()) return;
  begin_overlays({.gbuffer = &frame.gbuffer(), .slack_m = sides_slack_m(*volume), .brightness = details.dim}, camera,
                 timer);
  voxel_view_.run(volume->voxels(), volume->direct_irradiance(), volume->indirect_irradiance(), camera,
                  {.mode = mode, .exposure_ev = exposure_ev(settings.exposure_ev)}, target_.framebuffer(), timer);
}

void Picture::show_lobe(const screen::Frame& frame, const Scene& scene, const Camera& camera,
                        const ViewDetails& details, const Settings& settings, gl::PassTimer& timer) {
  const auto* volume = frame.products().find<screen::FrameVolume>();
  const RadianceVolumeGl* radiance = volume != nullptr ? volume->radiance(timer) : nullptr;
  if (radiance == nullptr) return;
  begin_overlays({.gbuffer = &frame.gbuffer(), .slack_m = sides_slack_m(*volume), .brightness = details.dim}, camera,
                 timer);
  const glm::vec3 at = details.lobe_at.value_or(0.5f * (scene.bounds_min + scene.bounds_max));
  constexpr float LARGE = 2.0f;  // cells, so that it is seen in small ones
  lobe_view_.run(*radiance, camera,
                 {.cell = screen::nearest_cell(volume->voxels().grid, at),
                  .exposure_ev = exposure_ev(settings.exposure_ev),
                  .radius_cells = LARGE},
                 target_.framebuffer(), timer);
}

void Picture::show_lights(const screen::Frame& frame, const Camera& camera, View view, const ViewDetails& details,
                          const Settings& /*settings*/, gl::PassTimer& timer) {
  screen::LightsView::Shown shown;
  screen::LightsView::Options options;
  const auto* clusters = frame.products().find<screen::LightClusters>();
  if (view == View::light_tree) {
    if (const auto* tree = frame.products().find<screen::LightTree>())
      shown.lights = &light_tree_level_.run(*tree, details.layer, timer);
    options.mode = screen::LightsView::Mode::source;
  } else if (view == View::negative_lights) {
    shown.negative = frame.products().find<screen::NegativeLights>();
  } else {
    shown.lights = frame.products().find<screen::VirtualLightListGl>();
    if (view == View::clusters && clusters != nullptr) shown.area_lights = &clusters->area_lights;
    options.mode = view == View::clusters      ? screen::LightsView::Mode::cluster
                   : details.light_colour == 1 ? screen::LightsView::Mode::source
                                               : screen::LightsView::Mode::flux;
  }
  if (shown.lights == nullptr && shown.negative == nullptr) return;
  begin_overlays({.gbuffer = &frame.gbuffer(), .brightness = details.dim}, camera, timer);
  lights_view_.run(shown, camera, options, target_.framebuffer(), timer);
}

void Picture::show(const screen::Frame& frame, const Scene& scene, const Camera& camera, const ViewDetails& details,
                   const Settings& settings, gl::PassTimer& timer) {
  using Mode = screen::GBufferView::Mode;
  texture_ = nullptr;
  shown_ = &target_.picture();
  ViewDetails one_number = details;  // a texel
  one_number.channel = 1;
  const View view = view_of(settings.view);
  switch (view) {
    case View::albedo:
      return show_gbuffer(frame, scene, camera, Mode::albedo, settings, timer);
    case View::normals:
      return show_gbuffer(frame, scene, camera, Mode::shading_normal, settings, timer);
    case View::depth:
      return show_gbuffer(frame, scene, camera, Mode::depth, settings, timer);
    case View::texture:
      return show_named(frame, details.texture, details, settings, timer);
    case View::cluster_maps:
      return show_named(frame, "paraboloid_depth_maps distance", one_number, settings, timer);
    case View::low_resolution:
      one_number.layer = 0;
      if (find_texture(frame.textures(), SMOOTH_STEP) != nullptr)
        return show_named(frame, SMOOTH_STEP, one_number, settings, timer);
      return show_named(frame, "error estimate", one_number, settings, timer);
    default:
      break;
  }
  show_light(settings, timer);
  if (view == View::voxels)
    show_sides(frame, camera, SIDE_COLOURS[size_t(details.voxel_colour)], details, settings, timer);
  if (view == View::coverage) show_sides(frame, camera, screen::VoxelView::Mode::coverage, details, settings, timer);
  if (view == View::lobe) show_lobe(frame, scene, camera, details, settings, timer);
  if (view == View::lights || view == View::clusters || view == View::negative_lights || view == View::light_tree)
    show_lights(frame, camera, view, details, settings, timer);
}

void Picture::new_truth(const gl::Texture& reference) { error_floor_ = screen::error_floor(reference); }

void Picture::show_truth(const gl::Texture& reference, bool error, float wipe, float exposure_ev,
                         gl::PassTimer& timer) {
  shown_ = &target_.picture();
  if (error) {
    error_view_.run(radiance(), reference, {.floor_radiance = error_floor_}, target_.framebuffer(), timer);
    return;
  }
  const int column = wipe > 0.0f ? int(std::lround(wipe * float(size_.x))) : -1;
  wipe_.run(radiance(), reference, exposure_ev, column, target_.framebuffer(), timer);
}

std::string Picture::under(glm::vec2 pixel) const {
  if (texture_ == nullptr) return {};
  const auto at = screen::TextureView::texel_at(glm::ivec2(texture_->size()), screen::TextureView::Fit::aspect, size_,
                                                {pixel.x, float(size_.y) - pixel.y});
  if (!at) return {};
  const screen::TexelValue texel = screen::texel(*texture_, texture_layer_, *at);
  std::string text = fmt::format("({}, {}):", at->x, at->y);
  for (int c = 0; c < texel.kind.channels; ++c) text += fmt::format(" {:.6g}", texel.value[c]);
  return text;
}

}  // namespace volgi::demo
