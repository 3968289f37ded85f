#pragma once
#include <string>
#include <vector>

#include "screen/frame/choice.h"

namespace volgi::app {

/// A budget on a scene that the front had not seen.
struct FrontCheck {
  std::string scene, chosen;
  screen::Budget budget;
  bool reachable = false;                // by some setting, as measured
  bool said_so = false;                  // that it can, or cannot
  double ms = 0.0, error_percent = 0.0;  // as measured, of what was chosen
  double times_budget = 0.0;             // of the one or the other
  double times_best = 0.0;               // its error over the least of all settings that take no longer on this scene
  double times_fixed = 0.0;              // and over that of the one setting that is best for all scenes in that time
};

/// Every scene of the front in turn left out, and chosen for by the others, at the front's size and for indirect light.
/// Pure. Cost: a second or so.
std::vector<FrontCheck> leave_one_out(const screen::MeasuredFront& front, const std::vector<screen::Budget>& budgets);

/// Whether a check counts: within 1.3 of the budget, or where nothing reaches it the nearest and said to be.
bool keeps_budget(const FrontCheck& check);

/// As Markdown: a row a budget, and one for each scene that misses one.
std::string check_table(const std::vector<FrontCheck>& checks);

/// 50 ms to 2 s and 1 to 20 %.
std::vector<screen::Budget> usual_budgets();

}  // namespace volgi::app
