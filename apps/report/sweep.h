#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace volgi::app {

/// A technique with its parameters: one point a scene and light.
struct Setting {
  std::string technique;             // as the sweep's table names it
  std::string renderer;              // who makes the picture: the command "render" or "reference"
  std::vector<std::string> options;  // what follows `volgi COMMAND SCENE`, in pairs --name value
  std::string varied;                // what differs from the technique's own line; empty for that line itself
  std::vector<std::string> lights;   // full, indirect
  std::vector<std::string> scenes;   // by name; none: all of the report
  std::string times_at;              // another size that times are taken at with the first of the lights; empty: none
  std::optional<int> frames;         // none: the sweep's
  bool one_bounce = false;           // carries the first bounce only, and is compared with that as well
  bool baseline = false;             // the technique that others are held against

  /// The technique, and what it differs in: "volume --grid 16".
  std::string label() const { return varied.empty() ? technique : technique + " " + varied; }
};

/// What a report measures: scenes, picture size, frames a point, and every setting of every technique.
struct Sweep {
  std::vector<std::string> scenes;
  std::string size = "192x192";
  int frames = 5;                       // after two warm-up frames; 1: none, one cold frame
  std::vector<std::string> references;  // options of `volgi reference` where no reference is stored
  std::vector<Setting> settings;
};

/// Reads the table of techniques (data/report/full.json): each has a "name", its "options" as on the command line, and
/// a sweep: "vary" changes one option at a time through the values listed, "also" adds options together; with
/// "unvaried" false the technique's own line is no point. "baseline" marks what others are held against. "one_bounce"
/// says that it carries one bounce; "lights" and "varied_lights" are those that its own line and the others are
/// measured in, of the whole table where it names none. "times_at" and "frames" are a technique's or the table's.
/// @param name  of the file, for messages. @throws Error(bad_input) naming the technique and what is wrong with it.
Sweep parse_sweep(std::string_view json, const std::string& name);

/// `options` with those of `changes` in place of their own or added: --set NAME=VALUE replaces the same NAME.
std::vector<std::string> with_options(std::vector<std::string> options, const std::vector<std::string>& changes);

/// Words of a text, apart at spaces.
std::vector<std::string> words_of(const std::string& text);

}  // namespace volgi::app
