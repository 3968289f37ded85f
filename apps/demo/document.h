#pragma once
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/volgi/light_options.h"
#include "core/camera.h"
#include "core/light_file.h"
#include "core/scene.h"
#include "core/scene_source.h"

namespace volgi::demo {

/// What is open: a scene made of one file or several at a time of their animations, its light as somebody has changed
/// it, and a camera where the files have none.
///
/// Its constructor reads files and may run on any thread; everything else belongs to the thread that draws.
class Document {
 public:
  /// @param files  not empty: the first one's frame of reference is the scene's, the others are put beside it.
  /// @param light  what the command line adds. @param reading  of every file.
  /// @throws Error as SceneSource and LightOptions::apply.
  Document(std::vector<std::filesystem::path> files, const app::LightOptions& light, double time_s = 0.0,
           SceneReading reading = {});

  const std::vector<std::filesystem::path>& files() const { return files_; }
  std::string title() const;  // the files' names
  const Scene& scene() const { return scene_; }

  bool moves() const;  // some geometry, camera or light does
  /// It moves, or a film plays.
  bool animated() const;
  double duration_s() const;  // of the longest animation, or of the film where that is longer; 0 without any
  double time_s() const { return time_s_; }
  /// Geometry, cameras, lights and the film's picture of another time; what was changed stays changed.
  /// @returns whether an image is another than before: triangles and frames are to be made anew.
  /// @throws Error as SceneSource::move and AreaVideo::show.
  bool move(double time_s);

  /// The file's; or one in a closed place; or one that sees everything.
  const std::vector<Camera>& cameras() const { return scene_.cameras; }
  Camera first_camera() const { return scene_.cameras.empty() ? made_camera_ : scene_.cameras.front(); }
  /// Cells along the longest axis that suit it (voxel/grid.h).
  int grid_cells() const { return grid_cells_; }

  // --- Light. Numbers are those of scene().lights.
  const std::vector<Light>& lights() const { return scene_.lights; }
  /// From here on the light keeps what it is given, whatever its file's animations do.
  void set_light(size_t index, const Light& light);
  /// @returns its number.
  size_t add_light(const Light& light);
  void remove_light(size_t index);
  /// What a material emits, where textures let it; 0 turns it off. [W m^-2 sr^-1]
  void set_emission(size_t material, glm::vec3 radiance);
  /// As the files have it, and the command line's --lamp and --sun.
  void reset_light();
  bool light_changed() const { return !changed_.empty() || !added_.empty() || !removed_.empty() || !emission_.empty(); }
  /// All of it, for `volgi render --lights`.
  LightFile light_file() const;

  /// Text as --sky takes it, empty for none; turned by degrees. @throws Error as LightOptions::apply.
  void set_sky(const std::string& sky, double rotate_deg);
  /// The sky as a text.
  const std::string& sky() const { return light_.sky; }
  double sky_rotate_deg() const { return light_.sky_rotate_deg; }
  const app::LightOptions& light_options() const { return light_; }
  /// A soft sky and a lamp beside the camera, put there because nothing else shines.
  bool has_default_light() const { return default_light_; }
  const SceneReading& reading() const { return reading_; }

 private:
  void move_sources(double time_s);
  void light_up();
  void add_default_light();
  bool shines() const;

  std::vector<std::filesystem::path> files_;
  SceneReading reading_;
  std::vector<std::unique_ptr<SceneSource>> sources_;
  std::vector<Scene> parts_;  // of several files: each alone
  app::LightOptions light_;
  Scene scene_;
  WorldBox box_;
  double time_s_ = 0.0, film_s_ = 0.0;
  Camera made_camera_;
  int grid_cells_ = 32;
  bool default_light_ = false;

  std::vector<glm::vec3> emission_of_file_;  // by material
  std::vector<Light> lights_of_files_;       // at this time
  std::map<size_t, Light> changed_;          // by their place among the files' and the command line's
  std::vector<size_t> removed_;
  std::vector<Light> added_;
  std::map<size_t, glm::vec3> emission_;
  std::vector<size_t> place_of_;  // scene_.lights -> their places; added ones behind
  size_t places_ = 0;
};

}  // namespace volgi::demo
