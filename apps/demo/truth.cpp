#include "apps/demo/truth.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <vector>

namespace volgi::demo {

namespace {

constexpr auto STILL = std::chrono::milliseconds(300);
constexpr auto BETWEEN_MEASUREMENTS = std::chrono::milliseconds(500);
constexpr int MOST_SAMPLES = 1 << 16;

/// The light that a view shows, as the path tracer can; none for views of other things.
std::optional<PathTracerOptions::Light> traced_light(const Session& session) {
  using Light = PathTracerOptions::Light;
  if (session.view() == View::direct) return Light::direct;
  if (session.view() != View::picture) return std::nullopt;
  switch (session.settings().frame.light) {
    case screen::LightPart::direct:
      return Light::direct;
    case screen::LightPart::indirect:
      return Light::indirect;
    case screen::LightPart::full:
      break;
  }
  return Light::full;
}

}  // namespace

void Truth::step(const Session& session) {
  const auto now = Clock::now();
  if (session.picture_version() != picture_version_) {
    picture_version_ = session.picture_version();
    changed_ = now;
    stop();
  }
  if (mode_ == TruthMode::off || !session.has_picture()) {
    stop();
    return;
  }
  if (!running_ && now - changed_ >= STILL && !session.playing() && traced_light(session)) begin(session);
  if (auto latest = running_ ? reference_.latest() : nullptr; latest && latest != snapshot_) take(std::move(latest));
}

void Truth::begin(const Session& session) {
  if (!scene_ || scene_version_ != session.scene_version()) {
    scene_ = std::make_shared<const Scene>(session.document().scene());
    scene_version_ = session.scene_version();
  }
  PathTracerOptions options;
  options.size = session.size();
  options.samples_per_pixel = MOST_SAMPLES;
  options.max_bounces = session.settings().frame.bounces;
  options.light = *traced_light(session);
  // An average of jittered frames is a box's.
  options.filter = session.settings().progressive ? PathTracerOptions::Filter::box : PathTracerOptions::Filter::point;
  reference_.start(scene_, session.camera(), options);
  running_ = true;
}

void Truth::stop() {
  if (!running_) return;
  reference_.stop();
  running_ = false;
  snapshot_.reset();
  measured_.reset();
}

void Truth::take(std::shared_ptr<const ReferenceSnapshot> snapshot) {
  snapshot_ = std::move(snapshot);
  const Image& image = snapshot_->image;
  const glm::ivec2 size(image.width, image.height);
  if (radiance_.id() == 0 || glm::ivec2(radiance_.size()) != size)
    radiance_ = gl::Texture::make_2d(GL_RGBA32F, size.x, size.y);
  std::vector<glm::vec3> rows;  // GL's first row is the picture's last
  rows.reserve(image.pixels.size());
  for (int y = size.y - 1; y >= 0; --y) {
    const auto row = image.pixels.begin() + std::ptrdiff_t(y) * size.x;
    rows.insert(rows.end(), row, row + size.x);
  }
  glTextureSubImage2D(radiance_.id(), 0, 0, 0, size.x, size.y, GL_RGB, GL_FLOAT, rows.data());
  new_ = true;
}

const std::optional<Metrics>& Truth::measured(const Session& session) {
  const std::pair both{session.picture().samples(), samples()};
  const auto now = Clock::now();
  if (!has_picture()) {
    measured_.reset();
  } else if (!measured_ || (both != measured_of_ && now - measured_at_ >= BETWEEN_MEASUREMENTS)) {
    measured_ = figures(session.picture().image(), *snapshot_);
    measured_of_ = both;
    measured_at_ = now;
  }
  return measured_;
}

}  // namespace volgi::demo
