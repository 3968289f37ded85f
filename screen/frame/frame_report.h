#pragma once
#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include "screen/frame/type_map.h"

namespace volgi::screen {

/// What a frame was made of, for --stats. Stages add to it.
class FrameReport {
 public:
  using Value = std::variant<double, bool, std::string, std::vector<double>>;
  struct Figure {
    std::string name;  // in --stats; "power_W.sent" is a member of "power_W"
    Value value;
    std::string words;  // for people: "1024 virtual lights"; empty: not worth a place on a line
  };

  /// A figure of a name that there is already takes its place.
  void add(std::string name, Value value, std::string words = {});
  const std::vector<Figure>& figures() const { return figures_; }
  /// 0 where there is none of that name.
  double number(const std::string& name) const;

  /// What a leaf tells in its own type: of<VolumeReport>().
  template <class T>
  T& of() {
    return details_.of<T>();
  }
  template <class T>
  const T& of() const {
    return details_.of<T>();
  }

  size_t memory_bytes = 0;  // of GL objects, and of the volume wherever it lies

 private:
  std::vector<Figure> figures_;
  TypeMap details_;
};

}  // namespace volgi::screen
