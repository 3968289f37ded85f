#include "propagation/lobes/sh_lobes_wave.h"

#include <bit>

namespace volgi {

namespace {

// Rows of a leaf's faces.
constexpr std::uint64_t kLowX = 0xff, kHighX = kLowX << 56;
constexpr std::uint64_t kLowY = 0x0101010101010101, kHighY = kLowY << 7;

}  // namespace

void LobeWave::find_beside(int number, const float* beside[6]) const {
  for (int face = 0; face < 6; ++face) {
    const int n = numbers_.beside(number, face);
    beside[face] = n < 0 ? LobeVolume::dark() : now_.leaf(n);
  }
}

std::uint64_t LobeWave::rows_reached(int number) const {
  if (dense_) return kAllRows;
  const std::uint64_t own = lit_[size_t(number)].any;
  const auto there = [&](int face) {
    const int n = numbers_.beside(number, face);
    return n < 0 ? LitRows{} : lit_[size_t(n)];
  };
  return own | own << 8 | own >> 8 | (own & ~kHighY) << 1 | (own & ~kLowY) >> 1 |  // within the leaf
         there(0).any >> 56 | there(1).any << 56 | (there(2).any & kHighY) >> 7 | (there(3).any & kLowY) << 7 |
         there(4).high | there(5).low;
}

void LobeWave::write_only(int number, std::uint64_t rows) {
  constexpr size_t kRowCells = 8;
  float* const leaf = next_.leaf(number);
  std::uint64_t& written = next_.rows_written(number);
  for (std::uint64_t stale = written & ~rows; stale != 0; stale &= stale - 1) {
    float* const row = leaf + kRowCells * size_t(std::countr_zero(stale));
    for (size_t block = 0; block < next_.leaf_floats(); block += kLobeLeafCells) {
      std::fill(row + block, row + block + kRowCells, 0.0f);
    }
  }
  written = rows;
}

/// Sums what `light_` says about the leaves, drops the dark ones.
void LobeWave::settle(LobeVolume& lobes) {
  std::vector<char> dark(light_.size());
  in_flight_ = glm::dvec3(0.0);
  size_t kept = 0;
  for (size_t i = 0; i < light_.size(); ++i) {
    const LeafLight light = light_[i];
    for (int band = 0; band < kLobeBands; ++band) in_flight_[band] += double(light.power[band]);
    const bool is_lit = light.power[0] > 0.0f || light.power[1] > 0.0f || light.power[2] > 0.0f;
    lit_[size_t(lobes.leaves()[i])] = {light.lit_rows, light.lit_low, light.lit_high};
    dark[i] = !is_lit && !dense_;
    if (dark[i] == 0) light_[kept++] = light;
  }
  light_.resize(kept);
  lobes.drop(dark);
}

/// Lit leaves, and those that they send light into.
std::vector<int> LobeWave::reached() const {
  std::vector<char> is_reached(size_t(numbers_.count()), dense_ ? 1 : 0);
  for (const int n : now_.leaves()) {
    if (dense_) break;
    is_reached[size_t(n)] = 1;
    const LitRows& lit = lit_[size_t(n)];
    const std::uint64_t at_face[6] = {lit.any & kLowX,  lit.any & kHighX, lit.any & kLowY,
                                      lit.any & kHighY, lit.low,          lit.high};
    for (int face = 0; face < 6; ++face) {
      const int beside = at_face[face] != 0 ? numbers_.beside(n, face) : -1;
      if (beside >= 0) is_reached[size_t(beside)] = 1;
    }
  }
  std::vector<int> leaves;
  for (int n = 0; n < numbers_.count(); ++n) {
    if (is_reached[size_t(n)] != 0) leaves.push_back(n);
  }
  return leaves;
}

}  // namespace volgi
