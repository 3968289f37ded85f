#pragma once
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/scene.h"

namespace volgi {

/// Light from outside a scene: radiance by direction, from infinitely far away (docs/conventions.md#radiometry). What
/// leaves the scene is lost in it. Light straight from it on a surface is direct light, and it is seen by the camera.
class Sky {
 public:
  /// The same radiance [W m^-2 sr^-1] from everywhere, below the horizon too.
  explicit Sky(glm::vec3 radiance);
  /// A latitude-longitude picture, twice as wide as high: row 0 is +Y, the middle column looks along -Z, columns to the
  /// right turn to +X. Bilinear between the middles of texels, around in u.
  /// @param rotation_rad  turns the picture about +Y, from -Z towards +X.
  explicit Sky(Image latitude_longitude, float rotation_rad = 0.0f, std::string name = "picture");

  /// What one sees who looks along `towards` (unit).
  glm::vec3 radiance(glm::vec3 towards) const;
  bool constant() const { return image_.width == 1; }
  const Image& image() const { return image_; }  // one texel where constant
  float rotation_rad() const { return rotation_rad_; }
  /// Integral of radiance over all directions [W m^-2]: over pi times what a small ball receives a unit of its surface.
  glm::dvec3 integral() const { return integral_; }
  /// Where texel coordinates (x, y), in texels from the upper left corner, look.
  glm::vec3 direction_at(double x, double y) const;
  /// Another one for every sky that was made, copies alike: what a cache may go by.
  std::uint64_t id() const { return id_; }
  /// For metadata and messages: "constant 1 1.1 1.3", or the picture's name.
  const std::string& name() const { return name_; }

 private:
  Image image_;
  glm::dvec3 integral_{0.0};
  std::uint64_t id_;
  float rotation_rad_ = 0.0f;
  std::string name_;
};

/// @throws Error(bad_input) naming the file: no EXR, not twice as wide as high, or values that are negative or no
/// numbers.
Sky read_sky(const std::filesystem::path& file, float rotation_rad);

/// A part of the sky, as a light that is far away.
struct SkyLight {
  glm::vec3 direction;   // unit, the way light travels
  float solid_angle_sr;  // that it stands for
  glm::vec3 irradiance;  // on a surface that faces it, nothing between [W m^-2]: the integral of radiance
};

/// `count` parts that together are the whole sky; what surfaces receive of all of them is what they receive of it, but
/// for the steps between. A constant sky: a spherical Fibonacci lattice (González 2010). Others: boxes of the picture,
/// halved where they hold most (Debevec 2005, "A Median Cut Algorithm for Light Probe Sampling"); we depart: a quarter
/// of what a box holds is its solid angle, so that no dark part of the sky gets so few lights that its shadows show.
/// The order has no meaning, but that any `count` / n that follow on one another at steps of n are spread over all.
std::vector<SkyLight> sky_lights(const Sky& sky, int count);

/// The same parts, of other directions in every picture of those that are averaged (core/sample_sequence.h): a constant
/// sky's lattice is turned and moved, and of a picture's boxes a place is drawn by the light that comes from it.
class SkyParts {
 public:
  SkyParts(std::shared_ptr<const Sky> sky, int count);
  /// As sky_lights() for sample 0. Cost of others: one look at every texel.
  std::vector<SkyLight> lights(int sample) const;

 private:
  std::shared_ptr<const Sky> sky_;
  int count_;
  std::vector<glm::ivec4> boxes_;  // of lights_: x, y, end x, end y [texels]; none of a constant sky
  std::vector<SkyLight> lights_;
};

/// A clear sky (Preetham, Shirley and Smits 1999, "A Practical Analytic Model for Daylight") in cd/m^2 read as W m^-2
/// sr^-1, without the sun's disk; below the horizon what ground of albedo 0.2 sends back.
/// @param elevation_rad  of the sun over the horizon, below it counts as on it. @param azimuth_rad  from -Z towards +X.
/// @param turbidity  haze: 2 very clear ... 10; the model holds for no more.
Sky clear_sky(double elevation_rad, double azimuth_rad, double turbidity);
/// The sun that belongs to clear_sky(): a directional light, what its extinction leaves of 128,000 lx. None below the
/// horizon: intensity 0.
Light sun_of_clear_sky(double elevation_rad, double azimuth_rad, double turbidity);

}  // namespace volgi
