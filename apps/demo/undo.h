#pragma once
#include <string>
#include <utility>
#include <vector>

namespace volgi::demo {

/// Earlier and later states of something that is changed step by step.
template <class State>
class UndoList {
 public:
  struct Step {
    std::string what;
    State before;
  };
  static constexpr size_t MOST_STEPS = 200;

  /// A change is about to be made. Changes of the same `what` in a row are one step: a slider that is dragged.
  void add(const std::string& what, const State& before) {
    redo_.clear();
    if (!open_ || undo_.empty() || undo_.back().what != what) undo_.push_back({what, before});
    if (undo_.size() > MOST_STEPS) undo_.erase(undo_.begin());
    open_ = true;
  }
  /// The next change is a step of its own, whatever its name.
  void close() { open_ = false; }
  bool can_undo() const { return !undo_.empty(); }
  bool can_redo() const { return !redo_.empty(); }
  /// Only where one can.
  State undo(const State& now) { return step(undo_, redo_, now); }
  State redo(const State& now) { return step(redo_, undo_, now); }
  const std::vector<Step>& steps() const { return undo_; }
  const std::vector<Step>& undone() const { return redo_; }

 private:
  State step(std::vector<Step>& from, std::vector<Step>& to, const State& now) {
    Step taken = std::move(from.back());
    from.pop_back();
    to.push_back({taken.what, now});
    open_ = false;
    return std::move(taken.before);
  }
  std::vector<Step> undo_, redo_;
  bool open_ = false;
};

}  // namespace volgi::demo
