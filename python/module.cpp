// The Python module: what the commands do, as arrays. Options are the command line's, as keywords: render(scene,
// gi="val", vpls=256, set={"val.map": 64}) is --gi val --vpls 256 --set val.map=64.
#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/volgi/automatic.h"
#include "apps/volgi/frame_options.h"
#include "apps/volgi/metrics_json.h"
#include "apps/volgi/scene_options.h"
#include "core/error.h"
#include "core/gl/context.h"
#include "core/log.h"
#include "core/scene_source.h"
#include "propagation/light_in/direct_light_cpu.h"
#include "propagation/radiance_volume.h"
#include "propagation/volume_cpu.h"
#include "reference/path_tracer.h"
#include "reference/picture_files.h"
#include "screen/base/image_from_texture.h"
#include "screen/frame/frame.h"
#include "screen/frame/registry.h"
#include "voxel/cell_volumes.h"
#include "voxel/vdb_file.h"

namespace py = pybind11;
using namespace volgi;

namespace {

using Array = py::array_t<float>;

std::string dashed(std::string name) {
  std::replace(name.begin(), name.end(), '_', '-');
  return "--" + name;
}

std::string text_of(const py::handle& value) {
  if (py::isinstance<py::tuple>(value)) {
    std::string text;
    for (const auto& item : value) text += (text.empty() ? "" : ",") + std::string(py::str(item));
    return text;
  }
  return std::string(py::str(value));
}

/// Keywords as the command line has them. True is a flag, a list an option that is repeated, a dict names with values,
/// a tuple numbers with commas; size=(w, h) is wxh.
std::vector<std::string> arguments_of(const py::kwargs& keywords) {
  std::vector<std::string> words;
  const auto add = [&](const std::string& name, const std::string& value) {
    words.push_back(name);
    words.push_back(value);
  };
  for (const auto& [key, value] : keywords) {
    const std::string name = dashed(std::string(py::str(key)));
    if (value.is_none() || value.is(py::bool_(false))) continue;
    if (value.is(py::bool_(true))) {
      words.push_back(name);
    } else if (py::isinstance<py::dict>(value)) {
      for (const auto& [k, v] : value.cast<py::dict>()) add(name, std::string(py::str(k)) + "=" + text_of(v));
    } else if (py::isinstance<py::list>(value)) {
      for (const auto& item : value) add(name, text_of(item));
    } else if (name == "--size" && py::isinstance<py::tuple>(value)) {
      const auto size = value.cast<std::pair<int, int>>();
      add(name, fmt::format("{}x{}", size.first, size.second));
    } else {
      add(name, text_of(value));
    }
  }
  return words;
}

void parse(CLI::App& command, std::vector<std::string> words) {
  try {
    std::reverse(words.begin(), words.end());
    command.parse(words);
  } catch (const CLI::ParseError& error) {
    throw Error(ExitCode::usage, error.what());
  }
}

/// height x width x 3; row 0 at the top.
Array array_of(const Image& image) {
  Array out({image.height, image.width, 3});
  std::memcpy(out.mutable_data(), image.pixels.data(), image.pixels.size() * sizeof(glm::vec3));
  return out;
}
Array array_of(const std::vector<float>& values, glm::ivec2 size) {
  Array out({size.y, size.x});
  std::memcpy(out.mutable_data(), values.data(), values.size() * sizeof(float));
  return out;
}
Image image_of(const py::array_t<float, py::array::c_style | py::array::forcecast>& array) {
  if (array.ndim() != 3 || array.shape(2) != 3)
    throw Error(ExitCode::usage, "a picture is an array of height x width x 3");
  Image image(int(array.shape(1)), int(array.shape(0)));
  std::memcpy(image.pixels.data(), array.data(), image.pixels.size() * sizeof(glm::vec3));
  return image;
}

/// A scene and the options that it was loaded with.
struct LoadedScene {
  app::SceneOptions options;
  Scene scene;

  LoadedScene(const std::string& path, const py::kwargs& keywords) {
    CLI::App command;
    options.add_to(command);
    std::vector<std::string> words = arguments_of(keywords);
    words.insert(words.begin(), path);
    parse(command, words);
    scene = SceneSource(options.scene_path, options.file.reading).at(options.time_s);
    options.light.apply(scene);
  }
};

/// One for all pictures, on the thread that asked first.
gl::Context& context() {
  static gl::Context* const made = new gl::Context();
  return *made;
}

constexpr const char* PATH_NAMES[] = {"emission_seen",  "punctual_direct", "emission_direct", "punctual_first",
                                      "emission_first", "punctual_higher", "emission_higher", "sky_seen",
                                      "sky_direct",     "sky_first",       "sky_higher"};
static_assert(std::size(PATH_NAMES) == screen::LIGHT_PATH_COUNT);

/// What a layer holds of the scene's light: "punctual_direct", or several joined by "+".
std::string layer_name(screen::LightPaths paths) {
  std::string name;
  for (int k = 0; k < screen::LIGHT_PATH_COUNT; ++k)
    if (paths.contains(screen::LightPath(k))) name += (name.empty() ? "" : "+") + std::string(PATH_NAMES[k]);
  return name.empty() ? "nothing" : name;
}

/// As `volgi render -o OUT.exr` has it: 8 pictures where something is half transparent.
py::dict render(LoadedScene& loaded, const py::kwargs& keywords) {
  CLI::App command;
  app::FrameCommandOptions asked;
  asked.add_to(command);
  std::string size = loaded.options.size_text;
  command.add_option("--size", size);
  parse(command, arguments_of(keywords));
  app::SceneOptions with_size = loaded.options;
  with_size.size_text = size;
  screen::FrameOptions options = asked.frame_options(with_size.size());
  const Camera camera = loaded.options.camera(loaded.scene);
  const auto automatic = app::choose_automatically(asked, loaded.scene, camera, options.size, context().device_name());
  if (automatic) {
    asked = automatic->frame;
    options = asked.frame_options(options.size);
  }
  if (screen::quality_from_name(asked.quality) == screen::Quality::truth)
    throw Error(ExitCode::usage, "quality='truth' climbs picture by picture: only the command does that");
  const int wanted = asked.fit(loaded.scene, glm::vec3(camera.world_from_camera[3]), 0, options).needs.samples;
  gl::PassTimer untimed(context().software(), false);
  screen::Frame frame(loaded.scene, options);
  frame.render(camera, untimed);
  py::dict out, layers;
  for (const screen::RadianceLayer& layer : frame.layers()) {
    const screen::LightPaths held = layer.paths & frame.wanted();
    if (!held.empty()) layers[layer_name(held).c_str()] = array_of(screen::image_from_texture(*layer.texture));
  }
  Image image = screen::image_from_texture(frame.radiance());
  const bool blends = std::any_of(loaded.scene.materials.begin(), loaded.scene.materials.end(),
                                  [](const Material& m) { return m.passes_by_chance(); });
  const int count = std::max(blends ? 8 : 1, wanted);
  for (int k = 1; k < count; ++k) {
    frame.set_sample(k, wanted > 1);
    frame.render(camera, untimed);
    const Image other = screen::image_from_texture(frame.radiance());
    for (size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] += other.pixels[i];
  }
  for (glm::vec3& p : image.pixels) p /= float(count);
  out["color"] = array_of(image);
  out["layers"] = layers;
  if (automatic) out["auto"] = py::module_::import("json").attr("loads")(automatic->json().dump());
  return out;
}

/// As `volgi reference`: spp, seed, bounces, size, light.
py::dict reference(LoadedScene& loaded, const py::kwargs& keywords) {
  CLI::App command;
  PathTracerOptions o;
  std::string size = loaded.options.size_text, light = "full";
  int bounces = -1;
  command.add_option("--size", size);
  command.add_option("--spp", o.samples_per_pixel);
  command.add_option("--seed", o.seed);
  command.add_option("--bounces", bounces);
  command.add_option("--light", light)->check(CLI::IsMember({"full", "direct", "indirect"}));
  parse(command, arguments_of(keywords));
  app::SceneOptions with_size = loaded.options;
  with_size.size_text = size;
  o.size = with_size.size();
  if (bounces >= 0) o.max_bounces = bounces;
  using Light = PathTracerOptions::Light;
  o.light = light == "direct" ? Light::direct : light == "indirect" ? Light::indirect : Light::full;
  const Camera camera = loaded.options.camera(loaded.scene);
  ReferencePicture picture;
  {
    const py::gil_scoped_release others_may_run;
    picture = path_trace(loaded.scene, camera, o);
  }
  Image noise = picture.half_a;
  for (size_t i = 0; i < noise.pixels.size(); ++i)
    noise.pixels[i] = 0.5f * (noise.pixels[i] - picture.half_b.pixels[i]);
  py::dict out;
  out["color"] = array_of(picture.color);
  out["direct"] = array_of(picture.direct);
  out["noise"] = array_of(noise);
  out["position"] = array_of(picture.position);
  out["normal"] = array_of(picture.normal);
  out["albedo"] = array_of(picture.albedo);
  out["id"] = array_of(picture.id, o.size);
  out["depth"] = array_of(picture.depth, o.size);
  return out;
}

/// The figures of `volgi compare`, over all pixels, or those of a mask.
py::dict compare(const Array& reference, const Array& test, const py::object& noise, const py::object& mask) {
  const Image r = image_of(reference), t = image_of(test);
  if (r.width != t.width || r.height != t.height) throw Error(ExitCode::usage, "the two pictures differ in size");
  std::optional<Image> n;
  if (!noise.is_none()) n = image_of(noise.cast<Array>());
  Mask pixels(r.pixels.size(), 1);
  if (!mask.is_none()) {
    const auto given = mask.cast<py::array_t<bool, py::array::c_style | py::array::forcecast>>();
    if (size_t(given.size()) != pixels.size()) throw Error(ExitCode::usage, "the mask has another size");
    for (size_t i = 0; i < pixels.size(); ++i) pixels[i] = given.data()[i] ? 1 : 0;
  }
  const std::string json = app::to_json(measure(r, t, n ? &*n : nullptr, pixels)).dump();
  return py::module_::import("json").attr("loads")(json);
}

/// x, y, z, channel.
Array cells_of(const openvdb::Vec3SGrid& grid, glm::ivec3 cells) {
  Array out({cells.x, cells.y, cells.z, 3});
  const auto values = grid.getConstAccessor();
  auto at = out.mutable_unchecked<4>();
  for (int x = 0; x < cells.x; ++x)
    for (int y = 0; y < cells.y; ++y)
      for (int z = 0; z < cells.z; ++z)
        for (int c = 0; c < 3; ++c) at(x, y, z, c) = values.getValue({x, y, z})[c];
  return out;
}

/// As `volgi export`: fluence and radiance by spherical harmonics, where the cells are, and how it went.
py::dict volume(LoadedScene& loaded, const std::string& vdb, const py::kwargs& keywords) {
  CLI::App command;
  app::VolumeCommandOptions asked;
  asked.add_to(command);
  parse(command, arguments_of(keywords));
  VolumeOptions options = asked.volume_options();
  asked.fit_grid(loaded.scene, options);
  VolumeCpu computed(loaded.scene, options);
  run_with_direct_light(computed, loaded.scene);
  const RadianceVolume radiance = computed.radiance();
  const Grid& grid = computed.grid();
  py::dict out, sh;
  for (size_t i = 0; i < radiance.sh.size(); ++i) sh[sh_grid_name(int(i))] = cells_of(*radiance.sh[i], grid.cells);
  const openvdb::Vec3SGrid::Ptr all = fluence(radiance);
  const glm::dvec3 origin = glm::dvec3(grid.origin) + loaded.scene.world_origin;
  out["fluence"] = cells_of(*all, grid.cells);
  out["sh"] = sh;
  out["origin_m"] = py::make_tuple(origin.x, origin.y, origin.z);
  out["cell_m"] = grid.cell_size_m;
  out["orders"] = computed.report().orders;
  out["converged"] = computed.report().converged;
  if (vdb.empty()) return out;
  all->setTransform(world_from_index(grid, loaded.scene.world_origin));
  label_grid(*all, {"fluence", "W m^-2", "radiance over all directions, sqrt(4 pi) sh_00, linear RGB"});
  write_vdb(vdb, {all}, openvdb::MetaMap());
  return out;
}

py::list parameters() {
  py::list out;
  const screen::TypeMap unset;
  for (const screen::Parameter* p : screen::parameters()) {
    py::dict one;
    one["name"] = p->name;
    one["unit"] = p->unit;
    one["help"] = p->help;
    one["default"] = screen::value_text(*p, unset);
    one["range"] = py::make_tuple(p->least, p->most);
    py::list names;
    for (const char* name : p->value_names) names.append(name);
    one["values"] = names;
    out.append(one);
  }
  return out;
}

}  // namespace

PYBIND11_MODULE(volgi, m) {
  m.doc() = "volgi: global illumination by volumes. Options are those of the command line, as keywords.";
  set_quiet(true);
  static py::exception<Error> error(m, "Error");
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Error& e) {
      error(e.what());
    }
  });
  py::class_<LoadedScene>(m, "Scene", "A scene, its lights and the camera that it is seen by: load().")
      .def_property_readonly("name", [](const LoadedScene& s) { return s.scene.name; })
      .def_property_readonly("triangles", [](const LoadedScene& s) { return s.scene.triangle_count(); })
      .def_property_readonly("lights", [](const LoadedScene& s) { return s.scene.lights.size(); })
      .def_property_readonly("bounds_m", [](const LoadedScene& s) {
        const glm::dvec3 low = glm::dvec3(s.scene.bounds_min) + s.scene.world_origin;
        const glm::dvec3 high = glm::dvec3(s.scene.bounds_max) + s.scene.world_origin;
        return py::make_tuple(py::make_tuple(low.x, low.y, low.z), py::make_tuple(high.x, high.y, high.z));
      });
  m.def(
      "load",
      [](const std::string& path, const py::kwargs& keywords) { return std::make_unique<LoadedScene>(path, keywords); },
      "load(path, size=(512, 512), camera=0, eye=..., sky=..., lamp=[...], ...): a scene as `volgi render` reads it.");
  m.def(
      "render", &render,
      "render(scene, gi='hybrid', light='full', grid=48, set={...}, size=..., ...): {'color': height x width x 3, row "
      "0 at the top, 'layers': the same by what light they hold}; equal to the command's EXR. With gi='auto', "
      "budget='3%' also 'auto': what was chosen, and the others.");
  m.def("reference", &reference,
        "reference(scene, spp=256, seed=1, bounces=N, light='full', size=...): path tracing; color, direct, noise, "
        "position, normal, albedo, id, depth.");
  m.def("compare", &compare, py::arg("reference"), py::arg("test"), py::arg("noise") = py::none(),
        py::arg("mask") = py::none(), "The figures of `volgi compare`, over all pixels or those of a mask.");
  m.def("volume", &volume, py::arg("scene"), py::arg("vdb") = "",
        "volume(scene, vdb='OUT.vdb', grid=48, scheme='ordinates', ...): 'fluence' and 'sh' by x, y, z, channel; where "
        "the cells are; with vdb the fluence is written, too.");
  m.def("parameters", &parameters, "What --set takes: name, unit, help, default, range, values.");
}
