#pragma once
#include <span>
#include <string>
#include <string_view>

namespace volgi::demo {

/// A key of the window, and the command that it stands for (apps/demo/commands.h).
struct KeyBinding {
  const char* key;  // "F", "Ctrl+Z", "Shift+1", "Space"
  const char* command;
  const char* help;
};
/// All but those that fly (W, A, S, D, Q, E) and those that move within panels.
std::span<const KeyBinding> key_bindings();

/// A key as GLFW numbers it, with its modifiers.
struct Key {
  int key = 0;
  bool control = false, shift = false;
  bool operator==(const Key&) const = default;
};
/// A key that went down, and what it writes.
struct KeyPress {
  Key key;
  std::string text;  // ASCII; empty for most
};
/// Of a binding's text. Asserts that there is such a key.
Key parse_key(std::string_view text);

}  // namespace volgi::demo
