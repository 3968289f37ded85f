#pragma once
#include <filesystem>
#include <optional>

#include "reference/metrics.h"
#include "reference/path_tracer.h"

namespace volgi {

/// A reference ready to be compared with: the requested light, its noise, and what regions need.
struct ReferenceFile {
  Image color;
  std::optional<Image> noise;          // half the difference of two independent halves
  std::optional<RegionLayers> layers;  // absent: only Region::all exists
  glm::ivec2 origin{0};                // of the upper left pixel on the picture (ChannelImage::origin)
  bool for_screen = false;             // a PNG: 8 bits, tone mapped
};

/// A picture to be judged.
struct TestPicture {
  Image color;
  glm::ivec2 origin{0};
  bool for_screen = false;
};

/// Both where they are both: pictures of other data windows show other pixels.
/// @throws Error(bad_input) naming both windows where they have no pixel in common.
void crop_to_common(ReferenceFile& reference, TestPicture& test);

/// Reads a reference: an EXR of `volgi reference`, or DIR/full.exr (one.exr, ...) with DIR/full_noise.exr, DIR/aov.exr,
/// DIR/direct.exr and DIR/direct_noise.exr beside it, as Blender writes them; or a PNG, for full light alone.
/// @param light  full: R,G,B as they are. direct: the direct layer, or direct.exr. indirect: R,G,B less direct, the
/// noise
///               likewise, unless R,G,B leave the direct light out already.
/// @throws Error(bad_input) for a file or a layer that is missing, naming it, and for pixels that are not finite.
ReferenceFile read_reference(const std::filesystem::path& path, PathTracerOptions::Light light);

/// Reads a picture to be judged: R,G,B; or of an EXR with direct.RGB that layer for direct, R,G,B less it for indirect.
/// A picture without that layer is taken to be the requested light. Or a PNG.
TestPicture read_test(const std::filesystem::path& path, PathTracerOptions::Light light);

}  // namespace volgi
