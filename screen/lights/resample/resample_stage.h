#pragma once
#include "screen/frame/stage.h"

namespace volgi::screen {

struct ResampleOptions {
  int candidates = 16;     // for each virtual light (ResampleVirtualLights); 1: take them as they come
  float near_zone = 4.0f;  // areas of a virtual light within which its sub-lights light (NearLights); 0: none
};

/// Virtual lights chosen from candidates by what they send to the picture (resample_virtual_lights.h), and, where a
/// later stage takes them, the parts that each consists of (virtual_light_subdivision.h). Makes VirtualLightListGl
/// anew, and VirtualLightSubdivision.
extern const StageType RESAMPLED_LIGHTS;

/// Whether lights can be had in parts with these options: they are pieces of a curve through candidates.
bool lights_are_subdivided(const FrameOptions& options);

/// What resampling asks of the stage that makes its candidates.
struct CandidatesAsked {
  int for_each_light = 1;
  bool along_curve = false;  // for parts
};
CandidatesAsked candidates_asked(const StageContext& of_candidates);

}  // namespace volgi::screen
