#pragma once
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/report/renderers.h"
#include "apps/report/report_scene.h"
#include "apps/report/sweep.h"

namespace volgi::app {

/// What all points of one run share.
struct MeasureContext {
  gl::Context& context;
  std::map<std::string, Renderer> renderers;
  std::filesystem::path folder;  // of the report; pictures go to folder/pictures
  glm::ivec2 size;
  int frames;
};

/// @throws Error(usage) for a setting that no renderer takes, naming it: before anything is measured.
void check_setting(const Setting& setting, const MeasureContext& context);

/// What a point is known by: scene content, technique, options, light, size, frames, device, machine, program; and
/// "key", the hash of all that. Two points of one key are the same measurement.
nlohmann::ordered_json point_identity(const ReportScene& scene, const Setting& setting, const std::string& light,
                                      const MeasureContext& context);

/// Measures one point: identity, command, times, memory, figures against `all_bounces` (and `one_bounce`, null where
/// there is none) and the names of its pictures. A picture with pixels that are not finite has "error" and no figures;
/// so has a setting that fails on this scene.
/// @throws Error(usage) for a setting that this scene cannot have, naming it; Error(cannot_write).
nlohmann::ordered_json measure_point(const ReportScene& scene, const Setting& setting, const std::string& light,
                                     const ReportReference& all_bounces, const ReportReference* one_bounce,
                                     const MeasureContext& context);

/// A reference's picture as pictures/SCENE-LIGHT.png, at the exposure that brings its mean to middle brightness, and
/// its radiance for the page's script as pictures/SCENE-LIGHT-radiance.png. @returns the name relative to the report's
/// folder.
std::string write_reference_picture(const ReportScene& scene, const std::string& light,
                                    const ReportReference& reference, const std::filesystem::path& folder);

}  // namespace volgi::app
