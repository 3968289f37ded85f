#pragma once

namespace volgi::gl {

/// Every raster pass begins with one of these and relies on nothing that another pass left behind. Both: no culling
/// (triangles have two sides), no scissor, no stencil, all channels written, depth from 0 to 1 and row 0 at the bottom.

/// Geometry with reversed depth: 1 near, 0 far, the greater wins. Clear depth to 0.
void begin_geometry_pass();
/// Geometry over what a geometry pass has drawn, in front of it alone: colours are multiplied, alpha takes the maximum.
void begin_filter_pass();
/// A triangle over the viewport, without depth.
/// @param add adds to the target instead of replacing it.
void begin_fullscreen_pass(bool add = false);

}  // namespace volgi::gl
