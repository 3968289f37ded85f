#include "apps/demo/commands.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "apps/demo/camera_control.h"
#include "apps/demo/command_text.h"
#include "apps/demo/presets.h"
#include "apps/volgi/parse_number.h"
#include "apps/volgi/volume_options.h"
#include "core/error.h"
#include "core/gl/shader_source.h"
#include "screen/frame/registry.h"

namespace volgi::demo {

namespace {

using Text = const std::string&;

Session& with_scene(Viewer& viewer) {
  if (!viewer.session.has_scene()) misused("no scene is open; open FILE");
  return viewer.session;
}

/// One change of settings that can be undone. @returns whether it was taken.
template <class Change>
bool change(Viewer& viewer, const std::string& what, const Change& make) {
  Settings settings = viewer.session.settings();
  make(settings);
  return viewer.session.change(what, settings);
}

// --- files

void open(Viewer& v, Text file) {
  if (file.empty()) misused("open: which file?");
  v.session.open({file});
}
void append(Viewer& v, Text file) {
  if (file.empty()) misused("append: which file?");
  v.session.append(file);
}
void reload(Viewer& v, Text) {
  const Document& document = with_scene(v).document();
  v.session.open(document.files(), document.time_s());
}
void screenshot(Viewer& v, Text name) {
  with_scene(v);
  std::filesystem::path path = name.empty() ? v.next_screenshot_name() : std::filesystem::path(name);
  if (path.extension() == ".png" || path.extension() == ".exr") path.replace_extension();
  v.want_screenshot(path);
}
void settings(Viewer& v, Text what) {
  const auto [verb, file] = split(what);
  if (verb == "save" && file.empty()) {
    v.save_settings();
  } else if (verb == "save") {
    write_settings(file, v.session.settings());
    v.session.say("wrote " + file);
  } else if (verb == "load" && !file.empty()) {
    const ReadSettings read = read_settings(file);
    for (const std::string& line : read.unknown) v.session.say(line);
    v.session.change("settings of " + file, read.settings);
  } else {
    misused("settings: save, save FILE or load FILE");
  }
}
void copy(Viewer& v, Text what) {
  const Session& session = with_scene(v);
  std::string text;
  if (what == "camera") {
    text = session.camera_arguments();
  } else if (what == "command") {
    const bool lit = session.document().light_changed();
    text = v.render_command("out.png", lit ? "lights.json" : "");
    if (lit) v.session.say("lights have been changed: `lights save lights.json` writes what the command needs");
  } else {
    misused("copy: camera or command");
  }
  v.hooks.copy_text(text);
  v.session.say("copied: " + text);
}

// --- technique

void recipe(Viewer& v, Text name) {
  const auto all = screen::recipes();
  const std::string now = screen::recipe_of(v.session.settings().frame).name;
  std::string wanted = name;
  if (name == "next" || name == "previous") {
    const auto at = std::find_if(all.begin(), all.end(), [&](const screen::Recipe& r) { return now == r.name; });
    const auto step = name == "next" ? 1 : all.size() - 1;
    wanted = all[(size_t(at - all.begin()) + step) % all.size()].name;
  }
  const bool taken = change(v, "recipe", [&](Settings& s) { take_recipe(wanted, s.frame); });
  if (taken) v.session.say("recipe " + wanted);
}
void set(Viewer& v, Text text) {
  const std::string name = text.substr(0, text.find('='));
  change(v, name, [&](Settings& s) { screen::set_parameter(s.frame.settings, text); });
}
void reset(Viewer& v, Text name) {
  change(v, name.empty() ? "reset" : "reset " + name, [&](Settings& s) {
    if (name.empty()) {
      reset_technique(s);
    } else {
      reset_parameter(s, screen::find_parameter(name));
    }
  });
}
void stage(Viewer& v, Text text) {
  const auto [name, state] = split(text);
  change(v, "stage " + name, [&](Settings& s) {
    auto& without = s.frame.without;
    if (const std::string why = idle_stage(s.frame, v.session.document().scene(), name); !why.empty()) misused(why);
    const bool off = std::find(without.begin(), without.end(), name) != without.end();
    if (state == "on" || (state == "toggle" && off)) {
      std::erase(without, name);
    } else if (state == "off" || state == "toggle") {
      if (!off) without.push_back(name);
    } else {
      misused("stage NAME on, off or toggle");
    }
  });
}
void preset(Viewer& v, Text name) {
  change(v, "preset " + name, [&](Settings& s) { apply_preset(name, s); });
}
void grid(Viewer& v, Text text) {
  change(v, "grid", [&](Settings& s) {
    s.grid_fits_scene = text == "auto";
    if (!s.grid_fits_scene)
      s.frame.of<VolumeOptions>().grid_cells = whole(text, "grid", 1, VolumeOptions::kMaxGridCells);
  });
}
void scheme(Viewer& v, Text name) {
  change(v, "scheme", [&](Settings& s) {
    SchemeOptions& o = s.frame.of<VolumeOptions>().scheme;
    o.scheme = app::scheme_from_name(name);
    if (o.scheme != Scheme::ordinates) o.directions.reset();
    if (o.scheme == Scheme::ordinates) o.sh_order = 1;
  });
}
void directions(Viewer& v, Text text) {
  change(v, "directions", [&](Settings& s) {
    auto& chosen = s.frame.of<VolumeOptions>().scheme.directions;
    chosen.reset();
    if (text == "auto") return;
    constexpr std::array KNOWN{8, 24, 48, 80, 128};
    const int count = whole(text, "directions", 8, 128);
    if (std::find(KNOWN.begin(), KNOWN.end(), count) == KNOWN.end()) misused("directions: auto, 8, 24, 48, 80 or 128");
    chosen = count;
  });
}
void sh_order(Viewer& v, Text text) {
  change(v, "sh-order",
         [&](Settings& s) { s.frame.of<VolumeOptions>().scheme.sh_order = whole(text, "sh-order", 1, 2); });
}
void iterations(Viewer& v, Text text) {
  change(v, "iterations", [&](Settings& s) {
    auto& chosen = s.frame.of<VolumeOptions>().iterations;
    chosen = text == "auto" ? std::nullopt : std::optional(whole(text, "iterations", 1, 100000));
  });
}
void bounces(Viewer& v, Text text) {
  change(v, "bounces", [&](Settings& s) {
    s.frame.bounces = text == "all" ? std::nullopt : std::optional(whole(text, "bounces", 0, 1000));
  });
}
void light_part(Viewer& v, Text name) {
  using screen::LightPart;
  change(v, "part", [&](Settings& s) {
    if (name != "full" && name != "direct" && name != "indirect") misused("part: full, direct or indirect");
    s.frame.light = name == "full" ? LightPart::full : name == "direct" ? LightPart::direct : LightPart::indirect;
  });
}
void backend(Viewer& v, Text name) {
  using screen::Backend;
  change(v, "backend", [&](Settings& s) {
    if (name != "auto" && name != "gpu" && name != "cpu") misused("backend: auto, gpu or cpu");
    s.frame.backend = name == "auto" ? Backend::automatic : name == "gpu" ? Backend::gpu : Backend::cpu;
  });
}
void shaders(Viewer& v, Text) { v.session.reload_shaders(); }
void undo(Viewer& v, Text) { v.session.undo(); }
void redo(Viewer& v, Text) { v.session.redo(); }

// --- picture

void view(Viewer& v, Text name) {
  change(v, "view", [&](Settings& s) { s.view = info(view_of(name)).name; });
}
void texture(Viewer& v, Text name) {
  v.session.details().texture = name;
  view(v, "texture");
}
void layer(Viewer& v, Text text) {
  int& now = v.session.details().layer;
  const int given = whole(text.starts_with("+") ? text.substr(1) : text, "layer", -65536, 65536);
  const bool step = text.starts_with("+") || text.starts_with("-");
  now = std::max(step ? now + given : given, 0);
}
void channel(Viewer& v, Text name) {
  constexpr std::array NAMES{"rgb", "r", "g", "b", "a", "length"};
  const auto* const found = std::find(NAMES.begin(), NAMES.end(), name);
  if (found == NAMES.end()) misused(fmt::format("channel: {}", fmt::join(NAMES, ", ")));
  v.session.details().channel = int(found - NAMES.begin());
}
void range(Viewer& v, Text text) {
  auto& chosen = v.session.details().range;
  const std::vector<double> ends = app::parse_numbers(text);
  if (text == "auto") {
    chosen.reset();
  } else if (ends.size() == 2 && ends[0] < ends[1]) {
    chosen = glm::vec2(glm::dvec2(ends[0], ends[1]));
  } else {
    misused("range: LOW,HIGH or auto");
  }
}
bool on_off(Text text, bool now, const char* what) {
  if (text == "on") return true;
  if (text == "off") return false;
  if (text.empty()) return !now;
  misused(fmt::format("{}: on or off; nothing: the other", what));
}
void log_scale(Viewer& v, Text text) {
  bool& now = v.session.details().log_scale;
  now = on_off(text, now, "log");
}
void voxel_colour(Viewer& v, Text name) {
  constexpr std::array NAMES{"irradiance", "direct", "indirect", "albedo", "coverage", "normal", "emission"};
  const auto* const found = std::find(NAMES.begin(), NAMES.end(), name);
  if (found == NAMES.end()) misused(fmt::format("voxels: {}", fmt::join(NAMES, ", ")));
  v.session.details().voxel_colour = int(found - NAMES.begin());
  view(v, "voxels");
}
void lobe(Viewer& v, Text text) {
  auto& at = v.session.details().lobe_at;
  const Scene& scene = with_scene(v).document().scene();
  if (!text.empty()) {
    at = glm::vec3(three(text, "lobe") - scene.world_origin);
  } else if (v.cursor) {
    at = v.session.world_under(*v.cursor);
  }
  view(v, "lobe");
}
void exposure(Viewer& v, Text text) {
  change(v, "exposure", [&](Settings& s) {
    if (text == "auto") {
      s.exposure_ev.reset();
    } else {
      s.exposure_ev = number(text, "exposure");
    }
  });
}
void expose(Viewer& v, Text text) {
  change(v, "exposure", [&](Settings& s) { s.exposure_ev = double(v.session.exposure_ev()) + number(text, "stops"); });
}
void filter(Viewer& v, Text text) {
  change(v, "filter", [&](Settings& s) { s.post_filter = on_off(text, s.post_filter, "filter"); });
}
void motion(Viewer& v, Text text) {
  const double fps = text == "off" ? 0.0 : number(text, "frames a second");
  if (!(fps >= 0.0 && fps <= 1000.0)) misused("motion: frames a second to keep, or off");
  change(v, "motion", [&](Settings& s) { s.motion_fps = fps; });
}
void average(Viewer& v, Text text) {
  change(v, "average", [&](Settings& s) {
    const auto most = app::parse_number<int>(text);
    if (most && (*most < 1 || *most > Settings::MOST_SAMPLES))
      misused("average: on, off, or how many pictures at most");
    if (most) s.most_samples = *most;
    s.progressive = most ? true : on_off(text, s.progressive, "average");
  });
}
void reference(Viewer& v, Text name) {
  const auto toggled = [&](TruthMode mode) { return v.truth.mode() == mode ? TruthMode::off : mode; };
  if (name.empty() || name == "beside") {
    v.truth.set_mode(name.empty() && v.truth.mode() != TruthMode::off ? TruthMode::off : TruthMode::beside);
  } else if (name == "alone") {
    v.truth.set_mode(toggled(TruthMode::alone));
  } else if (name == "error") {
    v.truth.set_mode(toggled(TruthMode::error));
  } else if (name == "off") {
    v.truth.set_mode(TruthMode::off);
  } else {
    misused("reference: beside, alone, error or off");
  }
}
void wipe(Viewer& v, Text text) { v.truth.set_wipe(float(std::clamp(number(text, "wipe"), 0.0, 1.0))); }

// --- camera

void frame(Viewer& v, Text) {
  Session& s = with_scene(v);
  const Scene& scene = s.document().scene();
  const double aspect = s.size().y > 0 ? double(s.size().x) / s.size().y : 1.0;
  s.set_camera(framed(s.camera(), scene.bounds_min, scene.bounds_max, aspect));
}
void camera(Viewer& v, Text text) {
  Session& s = with_scene(v);
  const size_t count = s.document().cameras().size();
  if (count == 0) misused(s.document().title() + " has no camera");
  if (text == "next") {
    s.take_file_camera(s.file_camera() ? (*s.file_camera() + 1) % count : 0);
  } else {
    s.take_file_camera(size_t(whole(text, "camera", 0, int(count) - 1)));
  }
}
void look(Viewer& v, Text text) {
  const auto [eye, rest] = split(text);
  const auto [target, yfov] = split(rest);
  Session& s = with_scene(v);
  const Scene& scene = s.document().scene();
  const float fov = yfov.empty() ? s.camera().yfov_rad : float(glm::radians(number(yfov, "field of view")));
  const glm::dvec3 from = three(eye, "eye"), to = three(target, "target");
  if (from == to || !(fov > 0.0f && fov < glm::pi<float>())) misused("look EYE TARGET [YFOV]: two points, and degrees");
  s.set_camera(look_at_camera(glm::vec3(from - scene.world_origin), glm::vec3(to - scene.world_origin), fov,
                              scene.bounds_min, scene.bounds_max));
}
void yfov(Viewer& v, Text text) {
  const double degrees = number(text, "field of view");
  if (!(degrees >= 1.0 && degrees <= 179.0)) misused("yfov: 1 to 179 degrees");
  Camera camera = with_scene(v).camera();
  camera.yfov_rad = float(glm::radians(degrees));
  v.session.set_camera(camera);
}
/// By pixels, as the mouse does.
void orbit(Viewer& v, Text text) {
  const std::vector<double> angles = app::parse_numbers(text);
  if (angles.size() != 2) misused("orbit YAW,PITCH in degrees");
  Session& s = with_scene(v);
  const Scene& scene = s.document().scene();
  s.set_camera(orbited(s.camera(), 0.5f * (scene.bounds_min + scene.bounds_max), glm::radians(angles[0]),
                       glm::radians(angles[1])));
}
void bookmark(Viewer& v, Text name) {
  with_scene(v);
  const auto [verb, rest] = split(name);
  if (verb == "next") {
    v.next_bookmark();
  } else if (verb == "go") {
    const auto& kept = v.bookmarks();
    const auto found = std::find_if(kept.begin(), kept.end(), [&](const Bookmark& b) { return b.name == rest; });
    if (found == kept.end()) misused("no camera is kept under '" + rest + "'");
    v.go_to(*found);
  } else if (verb == "delete") {
    std::erase_if(v.bookmarks(), [&](const Bookmark& b) { return b.name == rest; });
  } else {
    v.keep_bookmark(name);
  }
}
void record(Viewer& v, Text) {
  with_scene(v);
  v.toggle_recording();
}
void replay(Viewer& v, Text) {
  with_scene(v);
  v.toggle_replay();
}
void path(Viewer& v, Text text) {
  const auto [verb, file] = split(text);
  if (verb == "save" && !file.empty()) {
    write_camera_path(file, v.path());
    v.session.say("wrote " + file);
  } else if (verb == "load" && !file.empty()) {
    v.path() = read_camera_path(file);
  } else {
    misused("path: save FILE or load FILE");
  }
}

// --- light and time

size_t taken_light(Viewer& v) {
  if (!v.taken_light || *v.taken_light >= with_scene(v).document().lights().size())
    misused("no light is taken; L takes one");
  return *v.taken_light;
}
void put(Viewer& v, const Light& light) {
  v.session.document().set_light(taken_light(v), light);
  v.session.light_changed(false);
}
Light new_light(const Session& session, Text type) {
  const Scene& scene = session.document().scene();
  const float diagonal = glm::distance(scene.bounds_min, scene.bounds_max);
  const glm::mat4& eye = session.camera().world_from_camera;
  Light light;
  light.name = "new " + type;
  light.position = glm::vec3(eye[3]) - 0.1f * diagonal * glm::vec3(eye[2]);
  light.direction = glm::normalize(glm::vec3(-eye[2]));
  // As bright as the picture is, from a quarter of the scene.
  const float distance = 0.25f * diagonal;
  light.intensity = glm::vec3(distance * distance * glm::pi<float>() * std::exp2(-session.exposure_ev()));
  if (type == "point") return light;
  light.type = type == "spot" ? Light::Type::spot : Light::Type::directional;
  if (type == "spot") {
    light.outer_cone_rad = glm::radians(35.0f);
    light.inner_cone_rad = glm::radians(28.0f);
  } else if (type == "sun") {
    light.direction = glm::normalize(glm::vec3(-0.4f, -1.0f, -0.3f));
    light.intensity = glm::vec3(glm::pi<float>() * std::exp2(-session.exposure_ev()));
  } else {
    misused("light add: point, spot or sun");
  }
  return light;
}
void light(Viewer& v, Text text) {
  Session& s = with_scene(v);
  Document& document = s.document();
  const auto [verb, rest] = split(text);
  if (verb == "next") {
    const size_t count = document.lights().size();
    if (count == 0) misused("there is no light; light add point, spot or sun");
    v.taken_light = v.taken_light ? (*v.taken_light + 1) % count : 0;
    s.say(fmt::format("light {}: {}", *v.taken_light, document.lights()[*v.taken_light].name));
  } else if (verb == "add") {
    v.taken_light = document.add_light(new_light(s, rest));
    s.light_changed(true);
  } else if (verb == "take") {
    const int count = int(document.lights().size());
    v.taken_light = size_t(whole(rest, "light", 0, count - 1));
  } else if (verb == "delete") {
    document.remove_light(taken_light(v));
    v.taken_light.reset();
    s.light_changed(true);
  } else if (verb == "reset") {
    document.reset_light();
    v.taken_light.reset();
    s.light_changed(true);
  } else {
    Light changed = document.lights()[taken_light(v)];
    if (verb == "at") {
      changed.position = glm::vec3(three(rest, "position") - document.scene().world_origin);
    } else if (verb == "move") {
      changed.position += glm::vec3(three(rest, "way"));
    } else if (verb == "towards") {
      const glm::dvec3 way = three(rest, "direction");
      if (!(glm::length(way) > 0.0)) misused("light towards X,Y,Z: some direction");
      changed.direction = glm::vec3(glm::normalize(way));
    } else if (verb == "intensity") {
      const double brightness = number(rest, "intensity");
      if (!(brightness >= 0.0)) misused("light intensity: not negative");
      const float most = std::max({changed.intensity.x, changed.intensity.y, changed.intensity.z});
      changed.intensity = most > 0.0f ? changed.intensity * (float(brightness) / most) : glm::vec3(float(brightness));
    } else if (verb == "colour") {
      const glm::dvec3 colour = three(rest, "colour");
      if (!(std::min({colour.x, colour.y, colour.z}) >= 0.0)) misused("light colour R,G,B: not negative");
      changed.intensity = glm::vec3(colour);
    } else {
      misused(
          "light: next, take N, add TYPE, delete, reset, at X,Y,Z, move X,Y,Z, towards X,Y,Z, intensity I, colour "
          "R,G,B");
    }
    put(v, changed);
  }
}
void lights(Viewer& v, Text text) {
  const auto [verb, file] = split(text);
  if (verb != "save" || file.empty()) misused("lights: save FILE.json, for `volgi render --lights`");
  const Document& document = with_scene(v).document();
  write_light_file(file, document.light_file(), document.scene().world_origin);
  v.session.say("wrote " + file);
}
void emission(Viewer& v, Text text) {
  Document& document = with_scene(v).document();
  const auto [number_text, rest] = split(text);
  const int material = whole(number_text, "material", 0, int(document.scene().materials.size()) - 1);
  const glm::dvec3 radiance = three(rest, "radiance");
  if (!(std::min({radiance.x, radiance.y, radiance.z}) >= 0.0)) misused("emission MATERIAL R,G,B: not negative");
  document.set_emission(size_t(material), glm::vec3(radiance));
  v.session.light_changed(true);
}
void sky(Viewer& v, Text text) {
  Document& document = with_scene(v).document();
  document.set_sky(text == "none" ? "" : text, document.sky_rotate_deg());
  v.session.light_changed(true);
}
void sky_rotate(Viewer& v, Text text) {
  Document& document = with_scene(v).document();
  if (document.sky().empty()) misused("there is no sky; sky R,G,B, FILE.exr or sun:ELEVATION,AZIMUTH");
  document.set_sky(document.sky(), number(text, "sky-rotate"));
  v.session.light_changed(true);
}
void play(Viewer& v, Text text) {
  Session& s = with_scene(v);
  if (!s.document().animated()) misused(s.document().title() + ": nothing moves");
  s.play(on_off(text, s.playing(), "play"));
}
void time(Viewer& v, Text text) {
  Session& s = with_scene(v);
  if (!s.document().animated()) misused(s.document().title() + ": nothing moves");
  const bool step = !text.empty() && (text[0] == '+' || text[0] == '-');
  const double given = number(text.starts_with("+") ? text.substr(1) : text, "time");
  s.play(false);
  s.set_time(step ? s.document().time_s() + given : given);
}

void times(Viewer& v, Text text) {
  const auto [verb, file] = split(text);
  if (verb == "save" && !file.empty()) {
    v.times.write_csv(file);
    v.session.say("wrote " + file);
  } else {
    v.time_passes(on_off(text, v.times_passes, "times"));
  }
}

// --- window

void panel(Viewer& v, Text name) { v.hooks.toggle_panel(name); }
void keyboard(Viewer& v, Text) { v.hooks.toggle_panel("keyboard"); }
void palette(Viewer& v, Text) { v.hooks.toggle_panel("palette"); }
void help(Viewer& v, Text) { v.hooks.toggle_panel("help"); }
void fullscreen(Viewer& v, Text) { v.hooks.toggle_fullscreen(); }
void quit(Viewer& v, Text) { v.hooks.quit(); }

constexpr std::array COMMANDS = {
    Command{"open", "FILE", "opens a glTF file, or builtin:metaballs", open},
    Command{"append", "FILE", "puts a file beside what is open", append},
    Command{"reload", "", "reads the scene anew", reload},
    Command{"recipe", "NAME|next|previous", "technique, as --gi", recipe},
    Command{"stage", "NAME on|off|toggle", "a stage of the recipe", stage},
    Command{"set", "NAME=VALUE", "a parameter, as --set", set},
    Command{"reset", "[NAME]", "a parameter, or all of them, to what the recipe has", reset},
    Command{"preset", "fast|default|fine", "quality", preset},
    Command{"grid", "N|auto", "cells along the volume's longest axis, as --grid", grid},
    Command{"scheme", "NAME", "as --scheme", scheme},
    Command{"directions", "N|auto", "of ordinates, as --directions", directions},
    Command{"sh-order", "1|2", "as --sh-order", sh_order},
    Command{"iterations", "N|auto", "as --iterations", iterations},
    Command{"bounces", "N|all", "reflections, as --bounces", bounces},
    Command{"part", "full|direct|indirect", "light that is computed, as --light", light_part},
    Command{"backend", "auto|gpu|cpu", "where the volume is computed, as --backend", backend},
    Command{"shaders", "", "reads shaders anew (--shaders)", shaders},
    Command{"undo", "", "takes the last change back", undo},
    Command{"redo", "", "makes it again", redo},
    Command{"view", "NAME", "what is shown", view},
    Command{"texture", "NAME", "shows a texture that a pass has written", texture},
    Command{"layer", "N|+N|-N", "of the texture, the cluster, or the light tree's level", layer},
    Command{"channel", "rgb|r|g|b|a|length", "of the texture", channel},
    Command{"range", "LOW,HIGH|auto", "of the texture's values", range},
    Command{"log", "[on|off]", "logarithmic scale of the texture", log_scale},
    Command{"voxels", "irradiance|direct|indirect|albedo|coverage|normal|emission", "shows the volume's sides",
            voxel_colour},
    Command{"lobe", "[X,Y,Z]", "shows the lobe of the cell there, or under the cursor", lobe},
    Command{"exposure", "EV|auto", "stops before the tone map", exposure},
    Command{"expose", "EV", "so many stops more than now", expose},
    Command{"filter", "[on|off]", "smooths edges while something moves (FXAA)", filter},
    Command{"average", "[on|off|N]", "averages jittered pictures while nothing moves, N at most", average},
    Command{"motion", "FPS|off", "rate that quality gives way for while something moves", motion},
    Command{"reference", "[beside|alone|error|off]", "path traces in the background", reference},
    Command{"wipe", "SHARE", "of the width that is left of the reference", wipe},
    Command{"frame", "", "frames the scene", frame},
    Command{"camera", "N|next", "of the file", camera},
    Command{"look", "X,Y,Z X,Y,Z [DEGREES]", "eye, target and vertical field of view", look},
    Command{"yfov", "DEGREES", "vertical field of view", yfov},
    Command{"orbit", "YAW,PITCH", "around the scene's middle [degrees]", orbit},
    Command{"bookmark", "[NAME]|next|go NAME|delete NAME", "cameras that are kept with the scene", bookmark},
    Command{"record", "", "records the camera's path, and stops", record},
    Command{"replay", "", "plays the recorded path, and stops", replay},
    Command{"path", "save FILE|load FILE", "of the camera", path},
    Command{"light", "next|take N|add TYPE|delete|reset|at X,Y,Z|move X,Y,Z|towards X,Y,Z|intensity I|colour R,G,B",
            "lamps and suns", light},
    Command{"lights", "save FILE", "all of them, for `volgi render --lights`", lights},
    Command{"emission", "MATERIAL R,G,B", "what a material emits [W m^-2 sr^-1]", emission},
    Command{"sky", "R,G,B|FILE.exr|sun:ELEVATION,AZIMUTH[,TURBIDITY]|none", "as --sky", sky},
    Command{"sky-rotate", "DEGREES", "as --sky-rotate", sky_rotate},
    Command{"play", "[on|off]", "plays animations", play},
    Command{"time", "S|+S|-S", "of the animations [s]", time},
    Command{"times", "[on|off]|save FILE.csv", "times of single passes", times},
    Command{"screenshot", "[NAME]", "writes NAME.png, NAME.exr and the command that makes them", screenshot},
    Command{"copy", "camera|command", "as text", copy},
    Command{"settings", "save [FILE]|load FILE", "with bookmarks", settings},
    Command{"panel", "[NAME]", "shows or hides the panels, or one", panel},
    Command{"keyboard", "", "moves the keyboard into the panels", keyboard},
    Command{"palette", "", "a line for any command", palette},
    Command{"help", "", "keys and commands", help},
    Command{"fullscreen", "", "fills the screen, and back", fullscreen},
    Command{"quit", "", "ends the program", quit},
};

}  // namespace

std::span<const Command> commands() { return COMMANDS; }

void execute(Viewer& viewer, std::string_view line) {
  const auto [name, arguments] = split(line);
  std::vector<std::string> alike;
  for (const Command& command : COMMANDS) {
    if (name == command.name) {
      command.run(viewer, arguments);
      return;
    }
    if (std::string_view(command.name).starts_with(name)) alike.emplace_back(command.name);
  }
  misused(fmt::format("no command '{}'{}", name,
                      alike.empty() ? std::string("; F1 lists them") : fmt::format("; {}?", fmt::join(alike, ", "))));
}

namespace {

/// Lines that a command's first argument can make.
std::vector<std::string> lines_of(const Command& command, const Viewer& viewer) {
  std::vector<std::string> lines;
  const std::string name = command.name;
  const auto add = [&](const std::string& argument) { lines.push_back(name + ' ' + argument); };
  if (name == "set" || name == "reset") {
    for (const screen::Parameter* p : screen::parameters())
      add(name == "reset" ? std::string(p->name)
                          : fmt::format("{}={}", p->name, value_text(*p, viewer.session.settings().frame.settings)));
  } else if (name == "view") {
    for (const ViewInfo& v : views()) add(v.name);
  } else if (name == "recipe") {
    for (const screen::Recipe& r : screen::recipes()) add(r.name);
  } else if (name == "stage") {
    for (const screen::StageType* type :
         screen::find_recipe(screen::recipe_of(viewer.session.settings().frame).name).stages)
      add(std::string(type->name) + " toggle");
  } else if (name == "texture" && viewer.session.has_picture()) {
    for (const screen::NamedTexture& t : viewer.session.frame().textures()) add(t.name);
  } else if (name == "open" || name == "append") {
    for (const std::filesystem::path& file : viewer.session.settings().recent_files) add(file.string());
  } else {
    lines.push_back(name);
  }
  return lines;
}

}  // namespace

std::vector<std::string> completions(const Viewer& viewer, std::string_view line) {
  std::vector<std::string> first, within;
  for (const Command& command : COMMANDS) {
    for (std::string& whole_line : lines_of(command, viewer)) {
      const size_t at = whole_line.find(line);
      if (at == std::string::npos) continue;
      (at == 0 ? first : within).push_back(std::move(whole_line));
    }
  }
  first.insert(first.end(), within.begin(), within.end());
  return first;
}

}  // namespace volgi::demo
