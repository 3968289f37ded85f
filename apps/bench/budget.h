#pragma once
#include <algorithm>
#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

namespace volgi::app {

/// Wall time that the parts of a benchmark may take, each until a share of the whole is over. Estimates come from what
/// has been measured in the same part, so its works go from small to large.
class Budget {
 public:
  /// @param skipped  list that takes {part, what, estimate_s, left_s}; must outlive this.
  Budget(double seconds, nlohmann::json& skipped) : seconds_(seconds), skipped_(skipped) {}

  void begin_part(const char* part, double until_share) {
    part_ = part;
    end_s_ = until_share * seconds_;
    s_per_work_.clear();
  }
  /// Whether a picture of so much work, in a measure of the part's own, can be had in time: a cold frame and a warm
  /// one, by the slowest of its scene so far, or of all where it is the scene's first. What cannot is noted down.
  bool allows(const std::string& scene, const std::string& what, double work) const {
    const double estimate_s = 2.0 * s_per_work(scene) * work;
    if (estimate_s <= left_s()) return true;
    skipped_.push_back(
        {{"part", part_}, {"what", scene + " " + what}, {"estimate_s", estimate_s}, {"left_s", left_s()}});
    return false;
  }
  void took(const std::string& scene, double frame_s, double work) {
    double& slowest = s_per_work_[scene];
    slowest = std::max(slowest, frame_s / work);
  }
  /// Frames to measure: those that are wanted, with one more to warm up, or 1.
  int frames(double frame_s, int wanted) const { return frame_s * (wanted + 1) <= left_s() ? wanted : 1; }
  double elapsed_s() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  double s_per_work(const std::string& scene) const {
    const auto own = s_per_work_.find(scene);
    if (own != s_per_work_.end()) return own->second;
    double slowest = 0.0;
    for (const auto& [name, s] : s_per_work_) slowest = std::max(slowest, s);
    return slowest;
  }
  double left_s() const { return std::max(0.0, end_s_ - elapsed_s()); }

  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  double seconds_;
  nlohmann::json& skipped_;
  std::string part_;
  double end_s_ = 0.0;
  std::map<std::string, double> s_per_work_;
};

}  // namespace volgi::app
