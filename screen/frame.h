#pragma once
#include <memory>
#include <optional>

#include "core/gl/pass_timer.h"
#include "propagation/bounce_rules.h"
#include "screen/bounce_budget.h"
#include "screen/compose.h"
#include "screen/direct.h"
#include "screen/reflective_shadow_map.h"

namespace volgi::screen {

/// How the volume propagates light (--scheme).
enum class Scheme { ordinates, conservative };

struct FrameOptions {
  GiMode gi = GiMode::volume;
  LightPart light = LightPart::full;
  glm::ivec2 size{512, 512};
  int grid_cells = 32;               // along the longest axis
  glm::vec3 grid_shift_cells{0.0f};  // for tests (voxel/grid.h)
  std::optional<int> bounces;
  std::optional<int> iterations;
  Scheme scheme = Scheme::ordinates;
  std::optional<int> directions;  // of `ordinates`; none: what goes with the grid
  ReflectiveShadowMap::Resolution shadow_resolution;
};

/// What a frame was made of, for --stats.
struct FrameReport {
  glm::ivec3 grid{0};
  std::uint32_t sides = 0;
  BounceReport bounces;
  glm::vec3 injected{0.0f};  // flux that lit and emissive surfaces send [W]
  glm::vec3 lost{0.0f};      // part of it that found no side [W]
  size_t memory_bytes = 0;   // GPU
};

/// The frame: which passes run, and in which order. One scene, one picture size; render() as often as wanted.
/// Needs a current gl::Context.
class Frame {
 public:
  /// @throws Error as make_grid and gl::Buffer do.
  Frame(const Scene& scene, const FrameOptions& options);
  ~Frame();
  Frame(const Frame&) = delete;
  Frame& operator=(const Frame&) = delete;

  void render(const Camera& camera, gl::PassTimer& timer);
  const gl::Texture& radiance() const;
  /// Waits for the GPU; after a frame, not in one.
  FrameReport report() const;

 private:
  struct Volume;
  void run_volume(gl::PassTimer& timer);
  bool needs_shadow_maps() const;

  const Scene& scene_;
  FrameOptions options_;
  BounceBudget budget_;
  gl::SceneBuffers buffers_;
  ReflectiveShadowMap shadow_maps_;
  GBuffer gbuffer_;
  Direct direct_;
  Compose compose_;
  std::unique_ptr<Volume> volume_;  // none when nobody asks for its light
};

}  // namespace volgi::screen
