#pragma once
#include <span>
#include <string>
#include <vector>

#include "core/image.h"
#include "propagation/light_in/automatic_grid.h"
#include "screen/frame/frame_options.h"

namespace volgi::screen {

/// How much a picture may cost: what is asked of cells, lights, clusters and samples follows from it and from the
/// scene. Each costs more than the one before, and errs less.
enum class Quality { fast, standard, fine, truth };
inline constexpr const char* QUALITY_NAMES[] = {"fast", "default", "fine", "truth"};
/// @throws Error(usage) for another name, naming those that there are.
Quality quality_from_name(const std::string& name);

/// What a quality asks of a scene, in words of no technique; leaves turn it into their own parameters
/// (StageType::suit).
struct Needs {
  int cells = 48;              // along the grid's longest axis
  double lights = 1.0;         // virtual lights, and what stands for several of them, for one where rooms have one
  double maps = 1.0;           // edge of maps, of what is usual
  double interpolation = 1.0;  // error that neighbours may leave, of what is usual; 0: none, every pixel
  int samples = 1;             // pictures that are averaged

  bool operator==(const Needs&) const = default;
};

/// Lights that a scene needs for one that a room does: its lit area over the square of the way that light flies from
/// there. What is larger than a light's way to the next surface is no point to it. 1 up to what rooms have, 16 at most.
double lights_for(const SceneFacts& facts);

/// Pure. @param rung  of Quality::truth, from 0: each asks for more of everything.
Needs needs_of(Quality quality, int rung, const SceneFacts& facts);
/// More or less of two of them, in what there can be of them.
Needs scaled(Needs needs, double cells_times, double lights_times);

/// A parameter that a quality has chosen, as --set or an option of its own takes it.
struct Chosen {
  std::string name, value;
};
/// Gives every stage of the options' recipe what the needs ask of it, and the volume its cells.
/// @param keep  parameters that somebody has chosen, by name; "grid" is the number of cells.
/// @return what has changed.
std::vector<Chosen> apply_needs(const Needs& needs, std::span<const std::string> keep, FrameOptions& options);

/// Parameters' own values that apply_needs() would change, NAME=VALUE each: what a command has to say for them to stay.
std::vector<std::string> values_left_alone(const Needs& needs, const FrameOptions& options);

/// Quality::truth climbs from rung to rung until two successive answers differ by less than ENOUGH. Pure.
class Climb {
 public:
  static constexpr double ENOUGH_PERCENT = 1.0;
  static constexpr int RUNGS = 5;  // at most

  /// @param answer  of rung(). @return whether to go on with the next one.
  bool next(const Image& answer);
  int rung() const { return rung_; }  // to render next
  /// Root mean square of what each rung has changed, of the mean [%]; one less than there have been answers.
  const std::vector<double>& changes_percent() const { return changes_; }
  /// Whether the last two answers agree.
  bool agrees() const { return !changes_.empty() && changes_.back() < ENOUGH_PERCENT; }

 private:
  Image last_;
  int rung_ = 0;
  std::vector<double> changes_;
};

}  // namespace volgi::screen
