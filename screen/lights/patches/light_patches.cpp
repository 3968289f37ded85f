#include "screen/lights/patches/light_patches.h"

#include <bit>
#include <numeric>

#include "core/error.h"
#include "shaders/screen/lights/patches/light_patch.shared.h"
#include "shaders/screen/lights/patches/slots.shared.h"
#include "shaders/shared/group_sizes.shared.h"

namespace volgi::screen {

namespace {

using Light = LightPatchOptions::Light;
using Method = LightPatchOptions::Method;

std::vector<std::string> defines_of(Light light) {
  if (light == Light::summed) return {};
  return light == Light::exact ? std::vector<std::string>{"SAMPLED", "EXACT"} : std::vector<std::string>{"SAMPLED"};
}

void wait_for_patches() { glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT); }

}  // namespace

void LightPatches::check(const LightPatchOptions& options) {
  if (options.grid < 1 || !std::has_single_bit(unsigned(options.grid)))
    throw Error(ExitCode::usage,
                "patches.grid=" + std::to_string(options.grid) + ": must be a power of two, such as 16 or 32");
}

LightPatches::LightPatches(const LightPatchOptions& options)
    : options_(options),
      leaves_(gl::Program::compute("screen/lights/patches/patch_leaves.comp.glsl", defines_of(options.light))),
      depth_(gl::Program::compute("screen/lights/patches/patch_depth.comp.glsl", defines_of(options.light))),
      choose_(gl::Program::compute(
          "screen/lights/patches/choose_patches.comp.glsl",
          options.method == Method::radiosity ? std::vector<std::string>{"BY_SIZE"} : std::vector<std::string>{})) {
  check(options);
}

void LightPatches::make_room(const ReflectiveShadowMap& maps) {
  tree_.roots = 0;
  tree_.deepest = options_.method == Method::grid ? 0 : options_.depth;
  for (int light = 0; light < maps.light_count(); ++light) {
    const int inner = maps.resolution(light) - 2 * RSM_MARGIN_TEXELS;
    if (options_.grid > inner)
      throw Error(ExitCode::usage, "patches.grid=" + std::to_string(options_.grid) +
                                       ": more patches on a side of a map than the " + std::to_string(inner) +
                                       " texels that it has without its margin; make it less, or the map larger "
                                       "(shadow.spot, shadow.cube, shadow.sun)");
    while (options_.grid << tree_.deepest > inner) --tree_.deepest;
    tree_.roots += maps.layer_count(light) * options_.grid * options_.grid;
  }
  const int listed_on_side = options_.method == Method::radiosity ? options_.grid << deepest() : options_.grid;
  list_.of_light.clear();
  for (int light = 0; light < maps.light_count(); ++light)
    list_.of_light.push_back(maps.layer_count(light) * listed_on_side * listed_on_side);
  list_.reflected = std::accumulate(list_.of_light.begin(), list_.of_light.end(), 0);
  const auto patches = size_t(std::max(shared::first_of_depth(tree_.roots, deepest() + 1), 1));
  const GLuint before = tree_.patches.id();
  gl::reserve(tree_.patches, patches * sizeof(shared::LightPatch));
  if (tree_.patches.id() != before) tree_.thirds = gl::Texture::view_of(tree_.patches, GL_RGBA32F, sizeof(glm::vec4));
  gl::reserve(ranges_, patches * sizeof(shared::PatchRange));
  gl::reserve(list_.buffer, padded_count(list_) * sizeof(shared::VirtualLight));
}

void LightPatches::make_patches(int finest_patches) {
  for (int depth = deepest(); depth >= 0; --depth) {
    const gl::Program& program = depth == deepest() ? leaves_ : depth_;
    program.set("depth", depth);
    program.use();
    gl::dispatch_linear(size_t(finest_patches >> (2 * (deepest() - depth))), LINEAR_GROUP);
    wait_for_patches();
  }
}

void LightPatches::choose(int roots_of_light) {
  const int listed_to = options_.method == Method::radiosity ? deepest() : 0;
  choose_.set("deepest", listed_to);
  choose_.use();
  for (int depth = 0; depth <= listed_to; ++depth) {
    choose_.set("depth", depth);
    gl::dispatch_linear(size_t(roots_of_light) << (2 * depth), LINEAR_GROUP);
  }
}

void LightPatches::run(const ReflectiveShadowMap& maps, float scene_diagonal_m, gl::PassTimer& timer) {
  const auto scope = timer.scope(name);
  make_room(maps);
  list_.buffer.clear();
  int first_root = 0;
  for (int light = 0; light < maps.light_count(); ++light) {
    const int roots = maps.layer_count(light) * options_.grid * options_.grid;
    maps.bind(light);
    tree_.patches.bind_storage(PATCHES_SLOT);
    ranges_.bind_storage(PATCH_RANGES_SLOT);
    list_.buffer.bind_storage(CHOSEN_PATCHES_SLOT);
    for (const gl::Program* program : {&leaves_, &depth_, &choose_}) {
      program->set("light", light);
      program->set("root_count", tree_.roots);
      program->set("first_root", first_root);
      program->set("grid", options_.grid);
      program->set("depth_threshold_m", options_.depth_range * scene_diagonal_m);
      program->set("normal_threshold", options_.normal_range);
      program->set("at_edges", options_.edges ? 1 : 0);
    }
    make_patches(roots << (2 * deepest()));
    choose(roots);
    first_root += roots;
  }
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_UNIFORM_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT |
                  GL_BUFFER_UPDATE_BARRIER_BIT);
}

}  // namespace volgi::screen
