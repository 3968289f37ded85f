#include "screen/frame/frame_report.h"

#include <algorithm>
#include <utility>

namespace volgi::screen {

void FrameReport::add(std::string name, Value value, std::string words) {
  const auto same = [&](const Figure& f) { return f.name == name; };
  const auto found = std::find_if(figures_.begin(), figures_.end(), same);
  Figure figure{std::move(name), std::move(value), std::move(words)};
  if (found != figures_.end()) {
    *found = std::move(figure);
  } else {
    figures_.push_back(std::move(figure));
  }
}

double FrameReport::number(const std::string& name) const {
  for (const Figure& f : figures_) {
    const double* value = std::get_if<double>(&f.value);
    if (f.name == name && value != nullptr) return *value;
  }
  return 0.0;
}

}  // namespace volgi::screen
