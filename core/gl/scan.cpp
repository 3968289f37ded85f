#include "core/gl/scan.h"

#include <algorithm>

#include "shaders/shared/scan.shared.h"

namespace volgi::gl {

namespace {

size_t blocks_of(size_t count) { return std::max<size_t>(1, (count + SCAN_BLOCK - 1) / SCAN_BLOCK); }

void run(const Program& program, const Buffer& numbers, const Buffer& block_sums, size_t count) {
  numbers.bind_storage(SCAN_NUMBERS_SLOT);
  block_sums.bind_storage(SCAN_BLOCK_SUMS_SLOT);
  program.use();
  program.set("count", GLuint(count));
  dispatch_linear(count, SCAN_BLOCK);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

}  // namespace

Scan::Scan() : scan_(Program::compute("shared/scan.comp.glsl")), add_(Program::compute("shared/scan_add.comp.glsl")) {}

const Buffer& Scan::run(const Buffer& numbers, size_t count) {
  std::vector<size_t> counts{std::max<size_t>(count, 1)};
  while (counts.size() == 1 || counts.back() > 1) counts.push_back(blocks_of(counts.back()));
  const size_t levels = counts.size() - 1;
  if (block_sums_.size() < levels) block_sums_.resize(levels);
  const auto list = [&](size_t level) -> const Buffer& { return level == 0 ? numbers : block_sums_[level - 1]; };
  for (size_t level = 0; level < levels; ++level) {
    reserve(block_sums_[level], counts[level + 1] * sizeof(GLuint));
    gl::run(scan_, list(level), block_sums_[level], counts[level]);
  }
  for (size_t level = levels - 1; level-- > 0;) gl::run(add_, list(level), block_sums_[level], counts[level]);
  return block_sums_[levels - 1];
}

size_t Scan::bytes() const {
  size_t sum = 0;
  for (const Buffer& b : block_sums_) sum += b.bytes();
  return sum;
}

}  // namespace volgi::gl
