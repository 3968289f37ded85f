#include "screen/frame/plan.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"

namespace volgi::screen {

namespace {

struct Candidate {
  const StageType* type;
  StageRole role;
};

[[noreturn]] void refuse(const Recipe& recipe, const std::string& why) {
  throw Error(ExitCode::usage, fmt::format("--gi {}: {}", recipe.name, why));
}

bool has(const std::vector<Product>& products, const Product& p) {
  return std::find(products.begin(), products.end(), p) != products.end();
}

/// @param lacks  of all of them, active or not.
std::vector<Candidate> active_stages(const Recipe& recipe, const FrameOptions& options, bool shines,
                                     LightPaths& lacks) {
  std::vector<Candidate> stages;
  for (const StageType* type : recipe.stages) {
    if (!stages.empty() && type->slot < stages.back().type->slot)
      refuse(recipe, fmt::format("stage {} stands behind one of a later slot", type->name));
    StageRole role = type->role(options);
    lacks = lacks | role.lacks;
    if (!shines) std::erase_if(role.adds, [](const StageRole::Light& l) { return l.share == LightShare::mirror; });
    if (role.active) stages.push_back({type, std::move(role)});
  }
  return stages;
}

void check_needs(const Recipe& recipe, const std::vector<Candidate>& stages) {
  std::vector<Product> made;
  for (const Candidate& stage : stages) {
    for (const Product& need : stage.role.needs) {
      if (!has(made, need))
        refuse(recipe, fmt::format("stage {} needs {}, which no stage before it makes", stage.type->name, need.name));
    }
    made.insert(made.end(), stage.role.makes.begin(), stage.role.makes.end());
  }
}

/// Who carries a path, and how much of it.
struct Carriers {
  std::vector<const char*> whole, near, far, mirror;
};

Carriers carriers_of(LightPath path, const std::vector<Candidate>& stages) {
  Carriers c;
  if (BASE_PATHS.contains(path)) c.whole.push_back("base");
  for (const Candidate& stage : stages) {
    for (const StageRole::Light& light : stage.role.adds) {
      if (!light.paths.contains(path)) continue;
      std::vector<const char*>* const by_share[LIGHT_SHARE_COUNT] = {&c.whole, &c.near, &c.far, &c.mirror};
      by_share[int(light.share)]->push_back(stage.type->name);
    }
  }
  return c;
}

/// Each light path exactly once. @param cut  stages were left out: of what they carry the mirror's part may
/// be there alone.
void check_paths(const Recipe& recipe, const std::vector<Candidate>& stages, LightPaths wanted, bool cut) {
  for (int k = 0; k < LIGHT_PATH_COUNT; ++k) {
    const LightPath path{std::uint8_t(k)};
    const Carriers c = carriers_of(path, stages);
    const size_t near = c.near.size(), far = c.far.size(), whole = c.whole.size();
    if (whole > 1 || near > 1 || far > 1 || c.mirror.size() > 1 || (whole == 1 && near + far > 0))
      refuse(recipe, fmt::format("{}: counted twice", in_words(path)));
    if (near != far)
      refuse(recipe, fmt::format("{}: only the {} part is there", in_words(path), near > far ? "near" : "far"));
    const bool carried = whole + near > 0;
    if (!carried && !c.mirror.empty() && !cut)
      refuse(recipe, fmt::format("{}: only the mirror's part is there, of stage {}", in_words(path), c.mirror[0]));
    if (carried && !(recipe.claims | BASE_PATHS).contains(path))
      refuse(recipe, fmt::format("{}: stage {} adds it, which the recipe does not claim", in_words(path),
                                 whole > 0 ? c.whole[0] : c.near[0]));
    if (!carried && wanted.contains(path))
      refuse(recipe, fmt::format("nobody carries {} with these options", in_words(path)));
  }
}

LightPaths paths_of(const std::vector<StageRole::Light>& adds) {
  LightPaths sum;
  for (const StageRole::Light& light : adds) sum = sum | light.paths;
  return sum;
}

/// From the last stage to the first: whose light is wanted, or whose products are taken.
void keep_needed(std::vector<Candidate> stages, Plan& plan) {
  std::vector<Product> taken;
  for (auto stage = stages.rbegin(); stage != stages.rend(); ++stage) {
    const StageRole& role = stage->role;
    const bool is_taken =
        std::any_of(role.makes.begin(), role.makes.end(), [&](const Product& p) { return has(taken, p); });
    if (!is_taken && !paths_of(role.adds).meets(plan.wanted)) continue;
    for (const StageRole::Light& light : role.adds)
      plan.mirror_apart = plan.mirror_apart || (light.share == LightShare::mirror && light.paths.meets(plan.wanted));
    plan.steps.insert(plan.steps.begin(), {stage->type, taken, role.adds});
    taken.insert(taken.end(), role.needs.begin(), role.needs.end());
    taken.insert(taken.end(), role.uses.begin(), role.uses.end());
  }
}

}  // namespace

const char* slot_name(Slot slot) {
  constexpr const char* kNames[] = {"sources", "lights", "visibility", "gather", "bounces"};
  return kNames[int(slot)];
}

LightPaths paths_in(const Scene& scene) {
  LightPaths paths;
  if (scene.sky) paths = paths | LightPaths{LightPath::sky_seen};
  if (scene.triangle_count() == 0) return paths;
  if (scene.sky) paths = paths | SKY_PATHS;
  if (!scene.lights.empty()) paths = paths | PUNCTUAL_PATHS;
  for (const Mesh& mesh : scene.meshes) {
    if (scene.materials[size_t(mesh.material)].is_emissive() && !mesh.triangles.empty()) paths = paths | EMISSION_PATHS;
  }
  return paths;
}

Plan plan_picture(const Recipe& recipe, const FrameOptions& options, LightPaths present, bool shines) {
  const LightPaths asked = asked_paths(options.light, options.bounces) & present;
  LightPaths lacks;
  const std::vector<Candidate> stages = active_stages(recipe, options, shines, lacks);
  Plan plan;
  plan.wanted = (asked & (recipe.claims | BASE_PATHS)) - lacks;
  plan.missing = asked - plan.wanted;
  check_needs(recipe, stages);
  check_paths(recipe, stages, plan.wanted, !options.without.empty());
  keep_needed(stages, plan);
  return plan;
}

void check_layers(const Plan::Step& step, std::span<const RadianceLayer> layers) {
  LightPaths seen[LIGHT_SHARE_COUNT];
  for (const RadianceLayer& layer : layers) {
    LightPaths of_share;
    for (const StageRole::Light& light : step.adds) {
      if (light.share == layer.share) of_share = of_share | light.paths;
    }
    if (!(layer.paths - of_share).empty() || seen[int(layer.share)].meets(layer.paths)) {
      throw Error(ExitCode::usage, fmt::format("stage {}: a layer of {} is not what its role says", step.type->name,
                                               in_words(layer.paths)));
    }
    seen[int(layer.share)] = seen[int(layer.share)] | layer.paths;
  }
}

}  // namespace volgi::screen
