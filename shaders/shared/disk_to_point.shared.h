// Irradiance of a one-sided Lambertian disk at a point: docs/conventions.md, "Virtual lights".
#ifndef VOLGI_DISK_TO_POINT_SHARED_H
#define VOLGI_DISK_TO_POINT_SHARED_H
#include "shared/base.shared.h"
SHARED_BEGIN

// Over the disk's flux [m^-2], 1 / area at most. Exact where the point's horizon leaves the disk whole: the two form
// factors of a point whose surface is parallel to the disk, and upright to it and turned to its axis (Howell, B-13 and
// B-14), with what cancels in them multiplied out. Nichols' form (2010, eq. 4.1) is the first of them on the axis; in
// a corner, where light leaves at grazing angles, it loses up to twice A / (pi d^2), however many lights there are.
// Nothing where the two lie in one plane, to a thousandth of the disk's radius: else a sheet's front would light its
// back, as positions are rounded.
// @param height   of the point over the disk's plane [m], >= 0.
// @param along    of the disk's middle over the point's horizon [m], > 0.
// @param facing   cosine between the disk's normal and the point's turned round.
// @param squared  distance of the disk's middle [m^2].
SHARED_FUNCTION float disk_to_point(float height, float along, float facing, float squared, float area_m2) {
  const float pi = 3.14159265f;
  float radius_squared = area_m2 / pi;
  float sum = squared + radius_squared, beyond = squared - radius_squared;
  float aside_squared = max(squared - height * height, 0.0f);
  float root = sqrt(max(sum * sum - 4.0f * radius_squared * aside_squared, 1e-30f));
  float parallel =
      beyond > 0.0f ? 2.0f * height * height / (root + beyond) : 0.5f * (root - beyond) / max(radius_squared, 1e-30f);
  float upright = 2.0f * height * (along - facing * height) / (root + sum);
  float lift = min(height, along);
  float in_plane = 1e-6f * radius_squared + 1e-30f;
  float apart = clamp(lift * lift / in_plane - 1.0f, 0.0f, 1.0f);
  return apart * clamp((facing * parallel + upright) / (pi * root), 0.0f, 1.0f / max(area_m2, 1e-30f));
}

// The same to second order in the disk's radius: it errs by 1.5 % at most where `squared` is DISK_FAR_AREAS areas, and
// by half a percent at twice that. Cheaper by a root and a division, and not bounded.
#define DISK_FAR_AREAS 4.0f
SHARED_FUNCTION float disk_to_point_from_afar(float height, float along, float facing, float squared, float area_m2) {
  const float one_over_pi = 0.318309886f;
  float inverse = 1.0f / (squared + 1e-30f);
  float q = one_over_pi * area_m2 * inverse;
  float bent = along * (1.0f - 3.0f * height * height * inverse) + facing * height;
  return max(one_over_pi * inverse * inverse * height * (along + q * bent), 0.0f);
}

// On the disk's axis, over flux and cosines and times the squared distance: how near a point is, from 0 to 1 / pi.
SHARED_FUNCTION float disk_nearness(float squared, float area_m2) {
  return squared / (3.14159265f * squared + area_m2 + 1e-30f);
}

SHARED_END
#endif
