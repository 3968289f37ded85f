#pragma once
#include <string>
#include <vector>

#include "core/scene.h"

namespace CLI {
class App;
}

namespace volgi::app {

/// How a scene's file is read: --scene, --animation, --root, --strict.
struct ReadingOptions {
  SceneReading reading;

  void add_to(CLI::App& command);
  /// Words of a command line that asks for the same.
  static std::vector<std::string> arguments(const SceneReading& reading);
};

}  // namespace volgi::app
