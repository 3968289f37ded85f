#pragma once
#include "propagation/lobes/sh_lobes.h"
#include "propagation/lobes/sh_lobes_kernels.h"
#include "propagation/radiance_volume.h"

namespace volgi {

/// Sum of lobes over passes: all the light that went through each cell, and the radiance that it amounts to.
class LobeSum {
 public:
  LobeSum(const LeafNumbers& numbers, int coefficients);
  /// Adds lobes of `conservative`, rescaled or not.
  void add(const LobeVolume& lobes, const LobeKernels& kernels);
  /// Sums of a leaf, made if need be, zero at first: [coefficient][band][512].
  float* leaf(int number);
  /// Isotropic radiance L sends 6 pi L h^2 through a cell: L_lm = 2/(3 h^2) I_lm, I the sum of intensities [W/sr].
  /// @param odd_sign  -1: of light that comes from where it went to (odd bands change sign).
  RadianceVolume radiance(const Grid& grid, float odd_sign = 1.0f) const;
  void clear();
  size_t bytes() const;
  /// What bytes() will be where light is in so many leaves.
  static size_t bytes_for(const LeafNumbers& numbers, int coefficients, size_t leaves);

 private:
  LeafNumbers numbers_;
  int coefficients_;
  std::vector<std::vector<float>> leaves_;  // by number; empty where no light was
};

}  // namespace volgi
