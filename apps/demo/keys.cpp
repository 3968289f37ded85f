#include "apps/demo/keys.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <array>
#include <cassert>
#include <utility>

namespace volgi::demo {

namespace {

constexpr std::array BINDINGS = {
    KeyBinding{"1", "view picture", "view: picture"},
    KeyBinding{"2", "view direct", "view: direct light"},
    KeyBinding{"3", "view first_bounce", "view: first bounce"},
    KeyBinding{"4", "view higher_bounces", "view: higher bounces"},
    KeyBinding{"5", "view emission", "view: emission"},
    KeyBinding{"6", "view albedo", "view: albedo"},
    KeyBinding{"7", "view normals", "view: normals"},
    KeyBinding{"8", "view depth", "view: depth"},
    KeyBinding{"9", "view voxels", "view: voxels"},
    KeyBinding{"0", "view coverage", "view: coverage of the volume's sides"},
    KeyBinding{"Shift+1", "view lobe", "view: lobe of the cell under the cursor"},
    KeyBinding{"Shift+2", "view lights", "view: virtual lights"},
    KeyBinding{"Shift+3", "view clusters", "view: clusters"},
    KeyBinding{"Shift+4", "view cluster_maps", "view: a cluster's depth map"},
    KeyBinding{"Shift+5", "view negative_lights", "view: negative lights"},
    KeyBinding{"Shift+6", "view low_resolution", "view: where low resolution was not enough"},
    KeyBinding{"Shift+7", "view texture", "view: any texture"},
    KeyBinding{"Shift+8", "view light_tree", "view: a level of the light tree"},
    KeyBinding{"[", "layer -1", "the layer, slice, cluster or level before"},
    KeyBinding{"]", "layer +1", "the next one"},
    KeyBinding{"G", "recipe next", "the next recipe"},
    KeyBinding{"Shift+G", "recipe previous", "the recipe before"},
    KeyBinding{"F", "frame", "frames the scene"},
    KeyBinding{"C", "camera next", "the file's next camera"},
    KeyBinding{"B", "bookmark", "keeps this camera with the scene"},
    KeyBinding{"N", "bookmark next", "goes to the next one that was kept"},
    KeyBinding{"Ctrl+C", "copy camera", "copies the camera as --eye, --target and --yfov"},
    KeyBinding{"Ctrl+Shift+C", "copy command", "copies the command that renders this picture"},
    KeyBinding{"L", "light next", "takes the next light"},
    KeyBinding{"Delete", "light delete", "deletes the light that is taken"},
    KeyBinding{"Space", "play", "plays or pauses animations"},
    KeyBinding{".", "time +0.04", "one twenty-fifth of a second on"},
    KeyBinding{",", "time -0.04", "and back"},
    KeyBinding{"R", "reference", "path traces in the background, beside the picture"},
    KeyBinding{"T", "reference alone", "the reference alone, and back"},
    KeyBinding{"Y", "reference error", "signed difference from the reference, and back"},
    KeyBinding{"-", "expose -0.25", "darker"},
    KeyBinding{"=", "expose 0.25", "brighter"},
    KeyBinding{"Backspace", "exposure auto", "automatic exposure"},
    KeyBinding{"P", "screenshot", "writes PNG, EXR and the command that makes them"},
    KeyBinding{"V", "record", "records the camera's path, and stops"},
    KeyBinding{"Shift+V", "replay", "plays the recorded path"},
    KeyBinding{"Ctrl+Z", "undo", "takes the last change back"},
    KeyBinding{"Ctrl+Shift+Z", "redo", "makes it again"},
    KeyBinding{"Ctrl+S", "settings save", "saves settings and bookmarks"},
    KeyBinding{"Ctrl+R", "reload", "reads the scene anew"},
    KeyBinding{"F5", "shaders", "reads shaders anew (--shaders)"},
    KeyBinding{"Tab", "panel", "shows or hides the panels"},
    KeyBinding{"F2", "keyboard", "moves the keyboard into the panels; Escape brings it back"},
    KeyBinding{"Ctrl+P", "palette", "a line for any command"},
    KeyBinding{"F1", "help", "keys and commands"},
    KeyBinding{"F11", "fullscreen", "fills the screen, and back"},
    KeyBinding{"Ctrl+Q", "quit", "ends the program"},
};

constexpr std::array NAMED = {
    std::pair{"Space", GLFW_KEY_SPACE},
    std::pair{"Delete", GLFW_KEY_DELETE},
    std::pair{"Backspace", GLFW_KEY_BACKSPACE},
    std::pair{"Tab", GLFW_KEY_TAB},
    std::pair{"Left", GLFW_KEY_LEFT},
    std::pair{"Right", GLFW_KEY_RIGHT},
    std::pair{"Up", GLFW_KEY_UP},
    std::pair{"Down", GLFW_KEY_DOWN},
    std::pair{"PageUp", GLFW_KEY_PAGE_UP},
    std::pair{"PageDown", GLFW_KEY_PAGE_DOWN},
    std::pair{"F1", GLFW_KEY_F1},
    std::pair{"F2", GLFW_KEY_F2},
    std::pair{"F5", GLFW_KEY_F5},
    std::pair{"F11", GLFW_KEY_F11},
};

}  // namespace

std::span<const KeyBinding> key_bindings() { return BINDINGS; }

Key parse_key(std::string_view text) {
  Key key;
  for (const auto& [name, flag] : {std::pair{"Ctrl+", &Key::control}, std::pair{"Shift+", &Key::shift}}) {
    if (!text.starts_with(name)) continue;
    key.*flag = true;
    text.remove_prefix(std::string_view(name).size());
  }
  for (const auto& [name, number] : NAMED) {
    if (text == name) key.key = number;
  }
  // GLFW numbers printing keys by their characters on the US layout.
  if (key.key == 0 && text.size() == 1) key.key = text[0];
  assert(key.key != 0);
  return key;
}

}  // namespace volgi::demo
