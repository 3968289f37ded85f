#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/scene.h"
#include "reference/metrics.h"
#include "reference/picture_files.h"

namespace volgi::app {

/// The picture that points of one scene and light are judged by.
struct ReportReference {
  std::filesystem::path path;
  std::string command;  // that made it
  ReferenceFile file;
  Mask mask;  // noedge
};

/// Light and matter that a report adds to its scenes.
struct AddedLight {
  std::string arguments;                     // as commands have it: " --sky 1,1,1"; empty: nothing is added
  std::function<void(Scene&)> apply;         // there where anything is added
  std::vector<std::filesystem::path> files;  // that it is read from
};

/// A scene of a report, and where its references lie.
struct ReportScene {
  std::string name;
  std::filesystem::path path;
  std::string hash;             // of the file, and of what is added to it
  std::string light_arguments;  // AddedLight::arguments
  Scene scene;
  Camera camera;

  struct Stored {
    std::filesystem::path path;
    std::string command;
  };
  std::optional<Stored> all_bounces, one_bounce;  // none: to be computed; none at all
};

/// Finds SCENE: a name that DATA/scenes.json lists, or a file. Its stored references are taken where the file is, byte
/// for byte, the listed one, they have the size asked for, and nothing is added to it.
/// @throws Error(bad_input) for a name that is not listed and no file, naming those that are.
ReportScene open_report_scene(const std::string& name_or_file, const std::filesystem::path& data, glm::ivec2 size,
                              const AddedLight& added = {});

/// Reads the reference for a light; computes it first, into `folder`, where there is neither a stored nor an earlier
/// one. @param options of `volgi reference`: --spp N.  @param one_bounce  the stored one of one bounce; must exist.
ReportReference reference_of(ReportScene& scene, const std::string& light, bool one_bounce, glm::ivec2 size,
                             const std::vector<std::string>& options, const std::filesystem::path& folder);

}  // namespace volgi::app
