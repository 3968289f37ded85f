#pragma once
// Figures of whole frames by the tested backend.
#include <cmath>
#include <string>

#include "tests/support/frame_picture.h"
#include "tests/support/hard_case.h"

namespace volgi::test {

/// As expect_hard_case().
inline void expect_of_frame(const std::string& row, const std::string& what, double measured, double limit,
                            std::optional<double> asked = {}, const std::string& cause = {},
                            const std::string& unit = "%") {
  const bool on_cpu = tested_backend() == screen::Backend::cpu;
  expect_hard_case({row, what, on_cpu ? "CPU" : "GPU", measured, limit, asked, cause, unit}, gl::current_is_software());
}

/// Percent by which a ratio is not 1.
inline double off_percent(double ratio) { return 100.0 * std::abs(ratio - 1.0); }

}  // namespace volgi::test
