#include "apps/volgi/reading_options.h"

#include <CLI/CLI.hpp>

namespace volgi::app {

void ReadingOptions::add_to(CLI::App& command) {
  command.add_option("--scene", reading.scene, "scene of the file, counted from 0 (its default one, or the first)")
      ->check(CLI::NonNegativeNumber)
      ->type_name("INT");
  command
      .add_option(
          "--animation", reading.animation,
          "animation that plays: a number, a name, or all (all, but of those that move the same node the first)")
      ->type_name("N|NAME|all");
  command.add_option("--root", reading.root, "folder that the file's references may not leave (the file's own)")
      ->type_name("FOLDER");
  command.add_flag("--strict", reading.strict, "refuses faults of the file that could be repaired");
}

std::vector<std::string> ReadingOptions::arguments(const SceneReading& reading) {
  std::vector<std::string> words;
  if (reading.scene) words.insert(words.end(), {"--scene", std::to_string(*reading.scene)});
  if (!reading.animation.empty()) words.insert(words.end(), {"--animation", reading.animation});
  if (!reading.root.empty()) words.insert(words.end(), {"--root", reading.root.string()});
  if (reading.strict) words.emplace_back("--strict");
  return words;
}

}  // namespace volgi::app
