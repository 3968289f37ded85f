#include "apps/volgi/light_options.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <string_view>

#include "apps/volgi/parse_number.h"
#include "core/error.h"
#include "core/light_file.h"
#include "core/sky.h"

namespace volgi::app {
namespace {

Light lamp_of(const std::string& text, const Scene& scene) {
  const auto numbers = parse_numbers(text);
  if (numbers.size() != 4 || !(numbers[3] >= 0.0))
    throw Error(ExitCode::usage, fmt::format("--lamp {}: give X,Y,Z,I in metres and candela, such as 0,2,0,8", text));
  Light lamp;
  lamp.name = "--lamp " + text;
  lamp.type = Light::Type::point;
  lamp.position = glm::vec3(glm::dvec3(numbers[0], numbers[1], numbers[2]) - scene.world_origin);
  lamp.intensity = glm::vec3(float(numbers[3]));
  return lamp;
}

Light sun_of(const std::string& text) {
  const auto numbers = parse_numbers(text);
  if ((numbers.size() != 2 && numbers.size() != 3) || !(std::abs(numbers[0]) <= 90.0) ||
      (numbers.size() == 3 && !(numbers[2] >= 0.0)))
    throw Error(
        ExitCode::usage,
        fmt::format("--sun {}: give ELEVATION,AZIMUTH[,LUX] in degrees over the horizon and from -Z towards +X, "
                    "such as 45,30",
                    text));
  const double elevation = glm::radians(numbers[0]), azimuth = glm::radians(numbers[1]);
  const glm::dvec3 towards(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                           -std::cos(elevation) * std::cos(azimuth));
  Light sun;
  sun.name = "--sun " + text;
  sun.type = Light::Type::directional;
  sun.direction = glm::vec3(-towards);
  sun.intensity = glm::vec3(numbers.size() == 3 ? float(numbers[2]) : glm::pi<float>());
  return sun;
}

/// Of sun:ELEVATION,AZIMUTH[,TURBIDITY], in radians.
struct ClearSky {
  double elevation, azimuth, turbidity;
};
constexpr std::string_view kClearSky = "sun:";

ClearSky clear_sky_of(const std::string& text, double rotate_deg) {
  const auto numbers = parse_numbers(std::string_view(text).substr(kClearSky.size()));
  const bool well = (numbers.size() == 2 || numbers.size() == 3) && std::abs(numbers[0]) <= 90.0 &&
                    (numbers.size() == 2 || (numbers[2] >= 1.7 && numbers[2] <= 10.0));
  if (!well)
    throw Error(ExitCode::usage,
                fmt::format("--sky {}: give sun:ELEVATION,AZIMUTH[,TURBIDITY] in degrees over the horizon and from -Z "
                            "towards +X, haze from 1.7 (clear) to 10, such as sun:35,120,3",
                            text));
  return {glm::radians(numbers[0]), glm::radians(numbers[1] + rotate_deg), numbers.size() == 3 ? numbers[2] : 3.0};
}

}  // namespace

std::vector<double> parse_numbers(std::string_view text) {
  std::vector<double> numbers;
  for (bool more = true; more;) {
    const size_t comma = text.find(',');
    const auto number = parse_number<double>(text.substr(0, comma));
    if (!number) return {};
    numbers.push_back(*number);
    more = comma != std::string_view::npos;
    if (more) text.remove_prefix(comma + 1);
  }
  return numbers;
}

void LightOptions::add_to(CLI::App& command) {
  command.add_option("--lamp", lamps, "a point light more, in the file's frame [m, cd]; may be repeated")
      ->type_name("X,Y,Z,I");
  command.add_option("--sun", suns, "a sun more: degrees over the horizon, degrees from -Z towards +X, lux (pi)")
      ->type_name("ELEVATION,AZIMUTH[,LUX]");
  command.add_option("--lights", lights, "a file of lights in place of all others, as volgi-demo writes it")
      ->type_name("FILE.json");
  CLI::Option* of_sky =
      command
          .add_option(
              "--sky", sky,
              "light from outside: a radiance; a latitude-longitude picture (.exr, row 0 is +Y, the middle looks "
              "along -Z); or sun:ELEVATION,AZIMUTH[,TURBIDITY], a clear sky and its sun in lux")
          ->type_name("R,G,B|FILE.exr|sun:...");
  command.add_option("--sky-rotate", sky_rotate_deg, "turns the sky about +Y, from -Z towards +X [degrees]")
      ->needs(of_sky)
      ->capture_default_str();
  command.add_option("--lamp-scale", lamp_scale, "times the intensity of the file's own lamps and suns")
      ->check(CLI::Range(0.0, 1e12))
      ->capture_default_str();
  command
      .add_option(
          "--materials", materials,
          "gltf: surfaces shine as glTF's do; lambert: only their diffuse part, as the papers have it; phong: by "
          "Phong lobes about as wide as the file's roughness, or all of one exponent")
      ->type_name("gltf|lambert|phong[:N]")
      ->check([](const std::string& text) {
        return text == "gltf" || text == "lambert" || phong_of(text)
                   ? std::string()
                   : fmt::format("{}: give gltf, lambert, phong or phong:N, an exponent from 0 to 10000", text);
      })
      ->capture_default_str();
}

std::optional<double> LightOptions::phong_of(const std::string& materials) {
  if (materials == "phong") return -1.0;
  if (!materials.starts_with("phong:")) return std::nullopt;
  const auto numbers = parse_numbers(std::string_view(materials).substr(6));
  if (numbers.size() != 1 || !(numbers[0] >= 0.0 && numbers[0] <= 1e4)) return std::nullopt;
  return numbers[0];
}

void LightOptions::set_sky(const std::string& text, double rotate_deg) {
  sky = text;
  sky_rotate_deg = rotate_deg;
  made_sky_.reset();
}

std::string LightOptions::arguments() const {
  std::string text;
  const auto add = [&](const char* option, const std::string& value) { text += fmt::format(" {} {}", option, value); };
  for (const std::string& lamp : lamps) add("--lamp", lamp);
  for (const std::string& sun : suns) add("--sun", sun);
  if (!lights.empty()) add("--lights", lights.string());
  if (!sky.empty()) add("--sky", sky);
  if (sky_rotate_deg != 0.0) add("--sky-rotate", fmt::format("{}", sky_rotate_deg));
  if (lamp_scale != 1.0) add("--lamp-scale", fmt::format("{}", lamp_scale));
  if (materials != "gltf") add("--materials", materials);
  return text;
}

void LightOptions::put_sky(Scene& scene) const {
  if (sky.empty()) return;
  const bool clear = sky.starts_with(kClearSky);
  if (clear) {
    const ClearSky c = clear_sky_of(sky, sky_rotate_deg);
    scene.lights.push_back(sun_of_clear_sky(c.elevation, c.azimuth, c.turbidity));
    if (!made_sky_) made_sky_ = std::make_shared<Sky>(clear_sky(c.elevation, c.azimuth, c.turbidity));
  } else if (!made_sky_) {
    const auto numbers = parse_numbers(sky);
    if (numbers.size() == 3 && std::min({numbers[0], numbers[1], numbers[2]}) >= 0.0) {
      made_sky_ = std::make_shared<Sky>(glm::vec3(glm::dvec3(numbers[0], numbers[1], numbers[2])));
    } else if (sky.ends_with(".exr") || sky.ends_with(".EXR")) {
      made_sky_ = std::make_shared<Sky>(read_sky(sky, float(glm::radians(sky_rotate_deg))));
    } else {
      throw Error(ExitCode::usage,
                  fmt::format("--sky {}: give a radiance R,G,B, a latitude-longitude picture FILE.exr, "
                              "or sun:ELEVATION,AZIMUTH[,TURBIDITY]",
                              sky));
    }
  }
  scene.sky = made_sky_;
}

void LightOptions::apply(Scene& scene) const {
  for (Light& light : scene.lights) light.intensity *= float(lamp_scale);
  for (const std::string& text : lamps) scene.lights.push_back(lamp_of(text, scene));
  for (const std::string& text : suns) scene.lights.push_back(sun_of(text));
  put_sky(scene);
  const std::optional<double> exponent = phong_of(materials);
  for (Material& m : scene.materials) {
    m.lambertian = materials == "lambert";
    m.phong = exponent.has_value();
    // shared::phong_exponent() the other way round.
    if (exponent && *exponent >= 0.0) m.roughness_factor = float(std::pow(2.0 * *exponent + 1.0, -0.25));
  }
  if (!lights.empty()) apply_light_file(read_light_file(lights, scene.world_origin), lights, scene);
}

}  // namespace volgi::app
