#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/image.h"
#include "voxel/volume_field.h"

namespace volgi {

enum class VolumeMap { viridis, grey, diverging, colour };  // colour: values as they are, in sRGB
inline constexpr std::array<const char*, 4> kVolumeMapNames{"viridis", "grey", "diverging", "colour"};

enum class VolumePart { x, y, z, orbit };  // the slice across an axis; the occupied cells in space

/// How a field is looked at.
struct VolumeLook {
  std::string channel = "value";  // of channels_of()
  VolumeMap map = VolumeMap::viridis;
  double low = 0.0, high = 1.0;  // that the map spans; cells above `low` are those that are seen in space
  bool logarithmic = false;      // over at most four decades
  glm::ivec3 cell{0};            // the slices go through it
  double yaw_deg = 40.0, pitch_deg = 28.0, zoom = 1.0;  // of the look into space; zoom 1: all of it fits
  bool cut = false;  // in space, without what lies nearer than the chosen cell along all three axes
  std::vector<VolumePart> parts{VolumePart::z, VolumePart::x, VolumePart::y, VolumePart::orbit};  // 1 or 4
};

/// Channel, map and range that suit a field: colours as they are up to what 99.5 % of the cells do not exceed, numbers
/// in viridis from 0, or diverging where some are negative.
void suit_look(const VolumeField& field, VolumeLook& look);
/// Map and range for the channel that the look has.
void suit_range(const VolumeField& field, const VolumeScalars& scalars, VolumeLook& look);

/// A picture of a field: display values. Slices are enlarged without a filter and stand as in slice_picture.h, the
/// chosen cell framed; in space a pixel shows the first cell that holds a number above `low`, darker on sides that are
/// turned away. Cells without a value are grey, or nothing in space; those that are no number magenta. Captions and a
/// colour bar where there is room for them.
/// @param scalars  scalars_of(field, look.channel).
/// Cost: a walk through the cells for each pixel in space: 960 x 540 over 64^3 takes 0.04 s of one core.
Image volume_picture(const VolumeField& field, const VolumeScalars& scalars, const VolumeLook& look, glm::ivec2 size);

/// What part of such a picture is where. @returns none beside the parts.
std::optional<VolumePart> part_at(const VolumeLook& look, glm::ivec2 size, glm::ivec2 pixel);
/// Which cell a pixel shows; in space the first one behind it. @returns none where there is no cell.
std::optional<glm::ivec3> cell_at(const VolumeField& field, const VolumeScalars& scalars, const VolumeLook& look,
                                  glm::ivec2 size, glm::ivec2 pixel);

/// "cell 12, 8, 3 at 0.25, 1.1, -0.4 m: 1.2 0.8 0.4 W m^-2".
std::string cell_text(const VolumeField& field, glm::ivec3 cell);

}  // namespace volgi
