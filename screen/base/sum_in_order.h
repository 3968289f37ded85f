#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "core/gl/objects.h"
#include "core/gl/program.h"

namespace volgi::screen {

/// Sums of floats from the first on, in an order of additions that no GPU changes (screen/base/sum_in_order.glsl): 64
/// parts beside each other, each in its order. Whole numbers: gl::Scan.
class SumInOrder {
 public:
  /// @param file  includes screen/base/sum_in_order.glsl.
  SumInOrder(std::string_view file, std::vector<std::string> defines);
  void set(const char* name, int value) const;
  void run() const;  // with the file's own buffers bound; between storage barriers

 private:
  gl::Program parts_, all_;
  gl::Buffer part_sums_;
};

}  // namespace volgi::screen
