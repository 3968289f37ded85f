#pragma once
#include <algorithm>
#include <chrono>
#include <ctime>
#include <vector>

namespace volgi::app {

/// Wall time of one run [ms].
template <typename F>
double time_ms(const F& run) {
  const auto start = std::chrono::steady_clock::now();
  run();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

/// Processor time of this process so far, all threads [ms]: what else the machine does is not in it.
inline double processor_ms() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return 1e3 * double(t.tv_sec) + 1e-6 * double(t.tv_nsec);
}

inline double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// Median of `repeats` runs after one that warms up [ms].
template <typename F>
double median_ms(int repeats, const F& run) {
  run();
  std::vector<double> times;
  times.reserve(size_t(repeats));
  for (int i = 0; i < repeats; ++i) times.push_back(time_ms(run));
  return median(times);
}

/// Memory that all threads copy together, in pieces of the size of a leaf of lobes, as propagation moves it.
class Copying {
 public:
  explicit Copying(size_t bytes);
  void run();

 private:
  size_t pieces_;
  std::vector<char> from_, to_;
};

}  // namespace volgi::app
