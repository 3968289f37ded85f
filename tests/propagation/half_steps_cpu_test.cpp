// Steps of half a cell, with which the coarse part of `conservative` goes on: they must do what the fine grid's passes
// do.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <random>

#include "propagation/lobes/sh_lobes.h"
#include "propagation/lobes/sh_lobes_kernels.h"

namespace volgi::test {
namespace {

class HalfSteps : public testing::TestWithParam<std::tuple<int, const char*>> {
 protected:
  int order() const { return std::get<0>(GetParam()); }
  int coefficients() const { return order() == 1 ? 4 : 9; }
  size_t floats() const { return size_t(coefficients()) * kLobeBands * kLobeLeafCells; }
  void SetUp() override {
    kernels_ = lobe_kernels(order(), std::get<1>(GetParam()));
    if (kernels_ == nullptr) GTEST_SKIP() << "not on this machine";
  }

  struct Free {
    void operator()(float* p) const { std::free(p); }
  };
  using Leaf = std::unique_ptr<float[], Free>;
  Leaf leaf() const {
    Leaf out(static_cast<float*>(std::aligned_alloc(64, floats() * sizeof(float))));
    std::fill(out.get(), out.get() + floats(), 0.0f);
    return out;
  }

  const LobeKernels* kernels_ = nullptr;
};
INSTANTIATE_TEST_SUITE_P(Orders, HalfSteps,
                         testing::Combine(testing::Values(1, 2), testing::Values("baseline", "avx2", "avx512")));

using Closed = std::array<std::uint64_t, kLobeRows>;
const float* const kDark[6] = {LobeVolume::dark(), LobeVolume::dark(), LobeVolume::dark(),
                               LobeVolume::dark(), LobeVolume::dark(), LobeVolume::dark()};

int cell_of(int axis, int along) {  // in the middle of the other axes
  int cell[3] = {3, 3, 3};
  cell[axis] = along;
  return cell[0] * 64 + cell[1] * 8 + cell[2];
}
int along_of(int axis, int cell) { return axis == 0 ? cell >> 6 : axis == 1 ? (cell >> 3) & 7 : cell & 7; }

// Light whose amount is quadratic along an axis, of a shape that no face clamps: two coarse cells get from a step what
// the four fine ones that they are made of get from a pass, in every coefficient.
TEST_P(HalfSteps, MoveAndSpreadAsTheFineGrid) {
  constexpr float kShape[9] = {1.0f, 0.11f, -0.07f, 0.13f, 0.05f, -0.04f, 0.06f, 0.03f, -0.05f};
  const auto integral = [](double x) { return 2.0 * x + 0.15 * x * x + 0.1 * x * x * x; };
  const Closed open{};
  for (int axis = 0; axis < 3; ++axis) {
    const Leaf coarse = leaf(), fine = leaf(), coarse_out = leaf(), fine_out = leaf();
    for (int k = 0; k < coefficients(); ++k) {
      for (int band = 0; band < kLobeBands; ++band) {
        for (int i = 0; i < kLobeLeafCells; ++i) {
          const double c = along_of(axis, i), f = 2.0 + 0.5 * c;  // fine cells lie in the coarse cells 2 ... 5
          const int at = lobe_block(k, band) + i;
          coarse[size_t(at)] = kShape[k] * float(integral(c + 1.0) - integral(c));
          fine[size_t(at)] = kShape[k] * float(integral(f + 0.5) - integral(f));
        }
      }
    }
    kernels_->gather_half(coarse.get(), kDark, open.data(), coarse_out.get());
    kernels_->gather(fine.get(), kDark, open.data(), fine.get(), kAllRows, fine_out.get());
    for (int k = 0; k < coefficients(); ++k) {
      for (int c = 3; c <= 4; ++c) {
        const auto block = size_t(lobe_block(k, 1));
        const size_t low = block + size_t(cell_of(axis, 2 * (c - 2))), high = block + size_t(cell_of(axis, 2 * c - 3));
        const float expected = fine_out[low] + fine_out[high];
        EXPECT_NEAR(coarse_out[block + size_t(cell_of(axis, c))], expected, 2e-5f) << axis << " " << k << " " << c;
        if (k > 0) continue;
        EXPECT_GT(std::abs(expected - coarse[block + size_t(cell_of(axis, c))]), 0.02f);  // it moved
      }
    }
  }
}

// Beams among closed faces: nothing is negative, and what has left is half of what the closed faces are shown.
TEST_P(HalfSteps, KeepPower) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> number(-1.0f, 1.0f);
  for (int round = 0; round < 8; ++round) {
    const Leaf raw = leaf(), now = leaf(), next = leaf();
    for (int i = 0; i < kLobeBands * kLobeLeafCells; ++i) {
      raw[size_t(i)] = std::pow(std::abs(number(random)), 8.0f);  // most nearly dark
      for (int k = 1; k < coefficients(); ++k)
        raw[size_t(lobe_block(k, 0)) + size_t(i)] = 1.5f * number(random) * raw[size_t(i)];
    }
    Closed closed{};
    const auto close = [&](int cell, int face) {
      closed[size_t(cell >> 3)] |= std::uint64_t(1) << (8 * face + (cell & 7));
    };
    constexpr int kStep[3] = {64, 8, 1};
    for (int i = 0; i < kLobeLeafCells; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        const int along = along_of(axis, i);
        if (along == 7) close(i, 2 * axis + 1);
        if (along > 0 && number(random) < 0.8f) continue;
        close(i, 2 * axis);
        if (along > 0) close(i - kStep[axis], 2 * axis + 1);
      }
    }
    LeafLight before, after;
    kernels_->rescale(raw.get(), kAllRows, now.get(), false, before);
    kernels_->gather_half(now.get(), kDark, closed.data(), next.get());
    double shown[kLobeBands] = {};
    for (int i = 0; i < kLobeLeafCells; ++i) {
      for (int face = 0; face < 6; ++face) {
        if ((closed[size_t(i >> 3)] >> (8 * face + (i & 7)) & 1u) == 0) continue;
        float power[kLobeBands][8];
        kernels_->face_powers(now.get(), face, i, 1, power);
        for (int band = 0; band < kLobeBands; ++band) shown[band] += double(power[band][0]);
      }
    }
    for (int i = 0; i < kLobeBands * kLobeLeafCells; ++i) ASSERT_GE(next[size_t(i)], 0.0f);
    kernels_->rescale(next.get(), kAllRows, raw.get(), false, after);
    for (int band = 0; band < kLobeBands; ++band)
      EXPECT_NEAR(double(after.power[band]) + 0.5 * shown[band], double(before.power[band]),
                  1e-5 * double(before.power[band]));
  }
}

}  // namespace
}  // namespace volgi::test
