#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "apps/demo/session.h"

namespace volgi::demo {

/// What of `volgi render`'s arguments says how a frame is made: recipe, stages left out, light, bounces, backend, grid,
/// scheme, and each parameter that is not the recipe's own. The same arguments make the same frame.
std::vector<std::string> frame_arguments(const screen::FrameOptions& options, bool grid_fits_scene);

/// The command that renders a session's picture: scene, camera, light, frame, samples, exposure. For a shell.
/// @param light_file  that holds the document's light where it has been changed; empty: it is left out.
/// @throws Error(usage) for a scene of several files, which the command line cannot put together.
std::string render_command(const Session& session, const std::filesystem::path& out,
                           const std::filesystem::path& light_file);

}  // namespace volgi::demo
