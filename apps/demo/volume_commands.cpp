#include <fmt/ranges.h>

#include <array>

#include "apps/demo/command_text.h"
#include "apps/demo/volume_viewer.h"

namespace volgi::demo {

namespace {

using Text = const std::string&;

std::pair<double, double> two(Text text, const char* what) {
  const std::vector<double> v = app::parse_numbers(text);
  if (v.size() != 2) misused(fmt::format("'{}': {} is two numbers with a comma between", text, what));
  return {v[0], v[1]};
}

glm::ivec3 three_whole(Text text, const char* what) {
  const glm::dvec3 v = three(text, what);
  if (v != glm::floor(v) || glm::any(glm::greaterThan(glm::abs(v), glm::dvec3(1e9))))
    misused(fmt::format("'{}': {} is three whole numbers", text, what));
  return glm::ivec3(v);
}

void grid(VolumeViewer& v, Text name) {
  if (name == "next") return v.next_grid(1);
  if (name == "previous") return v.next_grid(-1);
  v.show_grid(name);
}
void channel(VolumeViewer& v, Text name) { name == "next" ? v.next_channel() : v.show_channel(name); }
void colours(VolumeViewer& v, Text name) {
  for (size_t k = 0; k < kVolumeMapNames.size(); ++k) {
    if (name == kVolumeMapNames[k]) return v.set_map(VolumeMap(k));
  }
  if (name != "next") misused(fmt::format("colours {}: {} or next", name, fmt::join(kVolumeMapNames, ", ")));
  const auto next = VolumeMap((size_t(v.look().map) + 1) % kVolumeMapNames.size());
  v.set_map(next == VolumeMap::colour && v.look().channel != "all" ? VolumeMap::viridis : next);
}
void range(VolumeViewer& v, Text text) {
  if (text == "whole") return v.whole_range();
  if (text == "auto") return v.suit_range();
  const auto [low, high] = two(text, "range");
  v.set_range(low, high);
}
bool switched(bool now, Text text, const char* what) {
  if (!text.empty() && text != "on" && text != "off") misused(fmt::format("{}: on, off or nothing to change it", what));
  return text.empty() ? !now : text == "on";
}
void log_scale(VolumeViewer& v, Text text) { v.set_logarithmic(switched(v.look().logarithmic, text, "log")); }
void cut(VolumeViewer& v, Text text) { v.set_cut(switched(v.look().cut, text, "cut")); }
void cell(VolumeViewer& v, Text text) { v.set_cell(three_whole(text, "cell")); }
void move(VolumeViewer& v, Text text) { v.move_cell(three_whole(text, "move")); }
void slice(VolumeViewer& v, Text text) {
  const size_t axis = text.size() > 2 && text[1] == '=' ? std::string_view("xyz").find(text[0]) : std::string::npos;
  if (axis == std::string::npos) misused(fmt::format("slice '{}': AXIS=INDEX, such as z=12", text));
  glm::ivec3 index = v.cell();
  index[int(axis)] = whole(text.substr(2), "slice", -1000000000, 1000000000);
  v.set_cell(index);
}
void direction(VolumeViewer& v, Text text) {
  const auto [azimuth, height] = two(text, "direction");
  v.set_direction({float(azimuth), float(height)});
}
void turn_direction(VolumeViewer& v, Text text) {
  const auto [azimuth, height] = two(text, "turn-direction");
  v.set_direction(v.direction_deg() + glm::vec2(float(azimuth), float(height)));
}
void view(VolumeViewer& v, Text name) { v.set_view(name); }
void orbit(VolumeViewer& v, Text text) {
  const auto [yaw, pitch] = two(text, "orbit");
  v.orbit(yaw, pitch);
}
void zoom(VolumeViewer& v, Text text) { v.zoom(number(text, "zoom")); }
void frame(VolumeViewer& v, Text) { v.reset_orbit(); }
void screenshot(VolumeViewer& v, Text name) { v.want_screenshot(name); }
void panel(VolumeViewer& v, Text) { v.panel_shown = !v.panel_shown; }
void help(VolumeViewer& v, Text) { v.help_shown = !v.help_shown; }
void quit(VolumeViewer& v, Text) { v.asked_to_quit = true; }

constexpr std::array COMMANDS = {
    VolumeCommand{"grid", "NAME|next|previous", "what is shown: a grid of the file, or radiance by direction", grid},
    VolumeCommand{"channel", "NAME|next", "all, luminance, red, green or blue; x, y or z of a normal", channel},
    VolumeCommand{"colours", "viridis|grey|diverging|colour|next", "map from values to colours; colour: as they are",
                  colours},
    VolumeCommand{"range", "LOW,HIGH|whole|auto", "that the map spans; in space, cells above LOW are seen", range},
    VolumeCommand{"log", "[on|off]", "logarithmic map", log_scale},
    VolumeCommand{"cut", "[on|off]", "opens the cells in space as far as the chosen one", cut},
    VolumeCommand{"cell", "X,Y,Z", "index of the cell that the slices go through", cell},
    VolumeCommand{"move", "X,Y,Z", "so many cells on", move},
    VolumeCommand{"slice", "AXIS=INDEX", "one of the three slices", slice},
    VolumeCommand{"direction", "AZIMUTH,HEIGHT", "that light travels towards, of radiance [degrees]", direction},
    VolumeCommand{"turn-direction", "AZIMUTH,HEIGHT", "so much on", turn_direction},
    VolumeCommand{"view", "sheet|x|y|z|orbit", "three slices and the cells in space, or one of them", view},
    VolumeCommand{"orbit", "YAW,PITCH", "around the volume [degrees]", orbit},
    VolumeCommand{"zoom", "FACTOR", "in space", zoom},
    VolumeCommand{"frame", "", "all of it, as at first", frame},
    VolumeCommand{"screenshot", "[NAME]", "writes NAME.png", screenshot},
    VolumeCommand{"panel", "", "shows or hides the panel", panel},
    VolumeCommand{"help", "", "keys and commands", help},
    VolumeCommand{"quit", "", "ends the program", quit},
};

constexpr std::array BINDINGS = {
    KeyBinding{"1", "view sheet", "three slices, and the cells in space"},
    KeyBinding{"2", "view x", "the slice across x"},
    KeyBinding{"3", "view y", "the slice across y"},
    KeyBinding{"4", "view z", "the slice across z"},
    KeyBinding{"5", "view orbit", "the cells in space"},
    KeyBinding{"G", "grid next", "the file's next grid"},
    KeyBinding{"Shift+G", "grid previous", "the grid before"},
    KeyBinding{"C", "channel next", "the next channel"},
    KeyBinding{"M", "colours next", "the next map of colours"},
    KeyBinding{"L", "log", "logarithmic, and back"},
    KeyBinding{"X", "cut", "cut open in space, and back"},
    KeyBinding{"R", "range whole", "the whole range of values"},
    KeyBinding{"Shift+R", "range auto", "the range of the first look"},
    KeyBinding{"Left", "move -1,0,0", "the cell before along x"},
    KeyBinding{"Right", "move 1,0,0", "the next one"},
    KeyBinding{"Down", "move 0,-1,0", "the cell below"},
    KeyBinding{"Up", "move 0,1,0", "the one above"},
    KeyBinding{"PageDown", "move 0,0,-1", "the cell before along z"},
    KeyBinding{"PageUp", "move 0,0,1", "the next one"},
    KeyBinding{"A", "orbit -15,0", "around the volume to the left"},
    KeyBinding{"D", "orbit 15,0", "and to the right"},
    KeyBinding{"W", "orbit 0,15", "up"},
    KeyBinding{"S", "orbit 0,-15", "and down"},
    KeyBinding{"=", "zoom 1.25", "nearer"},
    KeyBinding{"-", "zoom 0.8", "farther"},
    KeyBinding{"F", "frame", "all of it"},
    KeyBinding{"[", "turn-direction -15,0", "radiance of light that travels more to the left"},
    KeyBinding{"]", "turn-direction 15,0", "more to the right"},
    KeyBinding{"Shift+[", "turn-direction 0,-15", "more down"},
    KeyBinding{"Shift+]", "turn-direction 0,15", "more up"},
    KeyBinding{"P", "screenshot", "writes a PNG"},
    KeyBinding{"Tab", "panel", "shows or hides the panel"},
    KeyBinding{"F1", "help", "keys and commands"},
    KeyBinding{"Ctrl+Q", "quit", "ends the program"},
};

}  // namespace

std::span<const VolumeCommand> volume_commands() { return COMMANDS; }
std::span<const KeyBinding> volume_key_bindings() { return BINDINGS; }

void execute(VolumeViewer& viewer, std::string_view line) {
  const auto [name, arguments] = split(line);
  for (const VolumeCommand& command : COMMANDS) {
    if (name == command.name) return command.run(viewer, arguments);
  }
  std::vector<std::string_view> names;
  names.reserve(std::size(COMMANDS));
  for (const VolumeCommand& command : COMMANDS) names.emplace_back(command.name);
  misused(fmt::format("no command '{}' for a volume; there are {}", name, fmt::join(names, ", ")));
}

}  // namespace volgi::demo
