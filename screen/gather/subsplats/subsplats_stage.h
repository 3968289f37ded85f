#pragma once
#include <optional>

#include "screen/frame/stage.h"
#include "screen/gather/subsplats/light_form.h"

namespace volgi::screen {

struct SubsplatOptions {
  enum class Sum {
    gather,  // by the stencil, as chapter 4 of the thesis has it
    splat,   // as chapter 3
  } sum = Sum::gather;
  enum class Refine { geometry, compute } refine = Refine::geometry;  // of splat
  bool each_light = false;    // of splat: a list of subsplats for every light, by illumination
  float difference = 0.001f;  // of illumination, for each_light: of what all lights would give spread evenly
  int cells = 16;             // of the coarsest level along the picture's longer side, at least
  int finest = 1;             // pixels on a side of the finest level's squares: 1, 2, 4 ...
  float threshold = 0.1f;     // tau of eq. 4.8
  LightForm form = LightForm::disk;
  bool shine = false;  // surfaces reflect as their materials do; else as matt as their albedo
  enum class Visibility { none, negative, area_maps } visibility = Visibility::none;
};

/// Light of virtual lights at subsplats of many sizes: multiresolution splatting and gathering as Nichols 2010 prints
/// them in chapters 3 and 4 (discontinuity_mipmaps.h, subsplat_refinement.h, splat.h; flattened_buffer.h,
/// stencil_gather.h; upsample.h), without visibility, or with ours.
extern const StageType SUBSPLAT_GATHER;

}  // namespace volgi::screen
