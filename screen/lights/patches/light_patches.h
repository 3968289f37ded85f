#pragma once
#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "screen/base/reflective_shadow_map.h"
#include "screen/base/virtual_light_list_gl.h"

namespace volgi::screen {

struct LightPatchOptions {
  /// grid: one virtual light for each root, as chapter 3 samples the map. radiosity: patches of varying size, one set a
  /// frame (§4.2.3). hierarchical: roots, and the tree below them for each fragment to choose from (§4.2.4).
  enum class Method { grid, radiosity, hierarchical } method = Method::grid;
  int grid = 16;  // roots on a side of a layer of a map: a power of two
  /// Of the tree, of radiosity and hierarchical: parts of parts, up to MAX_PATCH_DEPTH, and no smaller than texels.
  int depth = 2;
  /// printed: what the middle texel shows stands for all of a patch, all solid angles are alike, areas without the
  /// cosine (eqs. 4.2 to 4.4). exact: the same texel, with the patch's own solid angle and the cosine. summed: flux and
  /// area of all its texels, mean position and normal by flux.
  enum class Light { printed, exact, summed } light = Light::printed;
  float depth_range = 0.05f;  // of radiosity: of the scene's diagonal; a patch with more is one of several surfaces
  float normal_range = 0.5f;  // the same for components of normals
  bool edges = false;         // of hierarchical: divides those from any distance, too; ours
};

/// The tree of patches as gathers take it. Roots are the virtual lights of the list.
struct LightPatchTree {
  static constexpr const char* product_name = "a tree of patches";
  gl::Buffer patches;  // shared::LightPatch, depth after depth
  gl::Texture thirds;  // a view of it, RGBA32F
  int roots = 0;       // of all layers of all lights
  int deepest = 0;
};

/// Pass "screen/lights/patches/light_patches": patches of light, squares of all lights' reflective shadow maps of 16^2
/// to the maps' resolution, with min-max mipmaps of depth and normals over them (Nichols 2010, §4.2.3 and §4.2.4), and
/// virtual lights of them. We depart: eq. 4.4 is a part of the sphere there and a solid angle in eq. 4.2; here it is a
/// solid angle [sr], whatever the field of view, and a light's own falloff counts; suns have areas for solid angles;
/// and `exact` and `summed` are ours. Cost: a look at every texel, and 4 / 3 patches a finest one.
class LightPatches {
 public:
  static constexpr const char* name = "screen/lights/patches/light_patches";
  /// @throws Error(usage) when the grid is no power of two.
  static void check(const LightPatchOptions& options);
  explicit LightPatches(const LightPatchOptions& options);

  /// @throws Error(usage) when roots are smaller than texels.
  void run(const ReflectiveShadowMap& maps, float scene_diagonal_m, gl::PassTimer& timer);

  const VirtualLightListGl& lights() const { return list_; }  // most of radiosity's have no flux
  const LightPatchTree& tree() const { return tree_; }
  size_t bytes() const { return tree_.patches.bytes() + ranges_.bytes() + list_.buffer.bytes(); }
  const gl::Buffer& ranges() const { return ranges_; }  // shared::PatchRange, as patches

 private:
  int deepest() const { return tree_.deepest; }
  void make_room(const ReflectiveShadowMap& maps);
  void make_patches(int patches_of_light_at_deepest);
  void choose(int roots_of_light);

  LightPatchOptions options_;
  LightPatchTree tree_;
  VirtualLightListGl list_;
  gl::Buffer ranges_;
  gl::Program leaves_, depth_, choose_;
};

}  // namespace volgi::screen
