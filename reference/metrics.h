#pragma once
#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "core/image.h"

namespace volgi {

/// Which pixels count. All but `all` need the auxiliary layers of a reference.
enum class Region {
  all,
  hit,     // geometry
  noedge,  // hit, and no edge of geometry or of direct shadow among the 3x3 neighbours
  shadow,  // noedge, and no direct light there
  lit,     // noedge, and direct light there
  shade,   // noedge, and no punctual light arrives there (a sky or emitters may light it)
};
std::string_view name(Region region);
std::optional<Region> region_from_name(std::string_view name);

using Mask = std::vector<char>;  // width * height, 0 or 1

/// What regions are made from.
struct RegionLayers {
  Image position, normal, direct;
  std::vector<float> id, depth;
  /// Bit k: punctual light k reaches the pixel. Empty where a reference does not say it: direct light is then taken to
  /// come from such lights alone, without noise.
  std::vector<float> lit{};
  Image direct_noise{};  // half the difference of the halves of `direct`; read with `lit` only
};
/// Cost: 35 comparisons a pixel. Source: compare.py of the reference images, regions().
Mask region_mask(Region region, const RegionLayers& layers);

/// How far a picture is from its reference. Percentages are of the reference's mean over the region and R, G, B.
/// "Denoised" figures have the reference's own Monte-Carlo noise taken out: E[(t-A)(t-B)] for its halves A and B.
struct Metrics {
  int pixels = 0;
  int nonfinite =
      0;             // test pixels that are NaN or infinite, in the whole picture; they count as 0 in all figures below
  int negative = 0;  // likewise
  double ref_mean = 0, test_mean = 0, test_max = 0;
  double mean_absolute = 0, max_absolute = 0;  // of |test - ref|
  /// Absent where the reference's mean is 0: only the absolute figures count there.
  struct Relative {
    double ratio = 0;  // test_mean / ref_mean
    std::array<double, 3> ratio_rgb{};
    double rmse_pct = 0, relmse = 0;
    std::optional<double> rmse_pct_denoised, relmse_denoised;
    double p95_percent = 0;                                  // of 100·|t-r| / max(r, 0.05·mean(r)), luminance
    double scale = 0;                                        // k that minimises |k·test - ref|
    std::optional<double> blk_pct, blkmax_pct, blkbias_pct;  // 16x16 block means; absent without a block of 32 pixels
    double ssim =
        0;  // of half-size, sRGB-encoded luminance exposed to a mean of 0.35; NaN for a region too thin for it
  };
  std::optional<Relative> relative;
};

/// @param noise  half the difference of the reference's halves, or null.
/// All pictures of the same size; sums are double. The figures agree with compare.py to rounding.
Metrics measure(const Image& ref, const Image& test, const Image* noise, const Mask& mask);

/// Means over whole blocks of pixels.
/// @throws Error(bad_input) when the size is not an integer multiple of width x height, naming both sizes.
Image box_downsample(const Image& image, int width, int height);

}  // namespace volgi
