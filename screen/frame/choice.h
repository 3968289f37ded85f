#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "propagation/light_in/automatic_grid.h"
#include "screen/frame/light_path.h"

namespace volgi::screen {

/// A scene as a camera sees it: what predictions of time and error go by.
struct PictureFacts {
  SceneFacts scene;
  double triangles = 0.0;
  double indirect_share = 0.0;  // of the light of what is seen
  double first_share = 0.0;     // of that, what has been reflected once: little where it comes through doors
  double noise = 0.0;           // of a traced picture of few samples, over its mean: much where light is concentrated
  double openness = 0.0;        // core/visibility/openness.h
  double cells = 0.0;           // of the whole grid, where nobody asks for a number
  double shadow_texels = 0.0;   // of all punctual lights' maps
  bool emits = false;           // surfaces or a sky
  bool sky = false;
};

/// A recipe and its parameters, as the command line has them.
struct FrontSetting {
  std::string name;  // in words: "none --quality fast"
  std::vector<std::string> options;
  int pictures = 1;  // that are averaged into one
};

/// A setting measured on a scene. None: not measured, or it failed.
struct FrontPoint {
  std::optional<double> ms, large_ms;                           // a picture of each of the front's sizes
  std::optional<double> error_percent, indirect_error_percent;  // rmse%* of all light, and of indirect light alone
};

struct FrontScene {
  std::string name;
  PictureFacts facts;
  std::vector<FrontPoint> points;  // one a setting
};

/// What settings take and give: measured on one device.
struct MeasuredFront {
  std::string device, machine, date;
  double pixels = 0.0, large_pixels = 0.0;  // of the two sizes that times are of
  std::vector<FrontSetting> settings;
  std::vector<FrontScene> scenes;
};

/// Another device's times over the front's, for each setting and size: 1 where nobody has measured them.
struct DeviceFactors {
  std::string device, date;
  std::vector<double> small, large;
};
MeasuredFront on_device(MeasuredFront front, const DeviceFactors& factors);

/// What a picture may take, or may be wrong by.
struct Budget {
  enum class Kind { time, error } kind = Kind::time;
  double amount = 0.0;  // ms, or % of the mean

  std::string text() const;
};
/// "50ms", "0.2s", "3%". @throws Error(usage) for anything else, and for nothing or less.
Budget parse_budget(const std::string& text);

/// What a scene that nobody has measured is thought to take and to show, by the scenes of the front.
struct Prediction {
  std::optional<double> ms, error_percent;
};
/// One for each setting. Pure. Cost: milliseconds.
std::vector<Prediction> predict(const MeasuredFront& front, const PictureFacts& facts, double pixels, LightPart light);

/// What has been chosen, and how it stands beside the others.
struct Choice {
  size_t setting = 0;
  bool reached = true;                  // else the nearest that there is
  std::vector<Prediction> predictions;  // one a setting
  std::vector<bool> allowed;            // one a setting
  double margin = 1.0;                  // that predictions were multiplied by: how often they are too low
  std::vector<std::string> nearest;     // scenes
};
/// The least error in the time, or the least time for the error. Pure.
/// @param allowed  by setting; none: all are. @throws Error(usage) where none is.
Choice choose(const MeasuredFront& front, const PictureFacts& facts, double pixels, LightPart light,
              const Budget& budget, const std::function<bool(const FrontSetting&)>& allowed = {});

}  // namespace volgi::screen
