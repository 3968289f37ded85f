#pragma once
#include <glm/glm.hpp>

#include "apps/demo/volume_viewer.h"

namespace volgi::demo {

/// The controls of a volume, right of its picture.
/// @returns width [px]; 0 where it is hidden.
int volume_panel_width(const VolumeViewer& viewer, glm::ivec2 window, float scale);
/// To be called within a frame of Dear ImGui. What it changes goes through execute(); what that refuses becomes the
/// viewer's message.
void draw_volume_panel(VolumeViewer& viewer, glm::ivec2 window, float scale);
void run_or_say(VolumeViewer& viewer, std::string_view command);

}  // namespace volgi::demo
