#include "propagation/sh_lobes_wave.h"

namespace volgi {

void LobeWave::find_beside(int number, const float* beside[6]) const {
  for (int face = 0; face < 6; ++face) {
    const int n = numbers_.beside(number, face);
    beside[face] = n < 0 ? LobeVolume::dark() : now_.leaf(n);
  }
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
    dark[i] = !is_lit && !dense_;
    if (dark[i] == 0) light_[kept++] = light;
  }
  light_.resize(kept);
  lobes.drop(dark);
}

/// Lit leaves, and those that they send light into.
std::vector<int> LobeWave::reached() const {
  std::vector<char> is_reached(size_t(numbers_.count()), dense_ ? 1 : 0);
  for (size_t i = 0; i < light_.size() && !dense_; ++i) {
    const int n = now_.leaves()[i];
    is_reached[size_t(n)] = 1;
    for (int face = 0; face < 6; ++face) {
      if (((light_[i].lit_faces >> face) & 1u) == 0) continue;
      const int beside = numbers_.beside(n, face);
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
