#include "screen/base/sum_in_order.h"

#include "shaders/screen/base/sum_in_order.shared.h"

namespace volgi::screen {

SumInOrder::SumInOrder(std::string_view file, std::vector<std::string> defines)
    : all_(gl::Program::compute(file, defines)), part_sums_(SUM_PARTS * sizeof(glm::vec4)) {
  defines.emplace_back("PART_SUMS");
  parts_ = gl::Program::compute(file, defines);
}

void SumInOrder::set(const char* name, int value) const {
  parts_.set(name, value);
  all_.set(name, value);
}

void SumInOrder::run() const {
  part_sums_.bind_storage(PART_SUMS_SLOT);
  for (const gl::Program* program : {&parts_, &all_}) {
    program->use();
    gl::dispatch({SUM_PARTS, 1, 1}, {1, 1, 1});
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  }
}

}  // namespace volgi::screen
