// What makes a picture out of a recipe, without OpenGL: each light path exactly once, or a refusal that names it.
#include "screen/frame/plan.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "screen/frame/registry.h"

namespace volgi::screen {
namespace {

using enum LightPath;

struct Apples {
  static constexpr const char* product_name = "apples";
};

/// A stage type whose role is given; it is never made.
template <StageRole (*role)(const FrameOptions&)>
StageType type_of(const char* name, Slot slot) {
  return {.name = name, .slot = slot, .parameters = {}, .role = role, .make = nullptr};
}
StageRole first(const FrameOptions&) { return {.adds = {{{punctual_first}}}}; }
StageRole near_first(const FrameOptions&) { return {.adds = {{{punctual_first}, LightShare::near}}}; }
StageRole far_first(const FrameOptions&) { return {.adds = {{{punctual_first}, LightShare::far}}}; }
StageRole mirrored_first(const FrameOptions&) { return {.adds = {{{punctual_first}, LightShare::mirror}}}; }
StageRole higher(const FrameOptions&) { return {.adds = {{{punctual_higher}}}}; }
StageRole direct(const FrameOptions&) { return {.adds = {{{punctual_direct}}}}; }
StageRole grows(const FrameOptions&) { return {.makes = {product<Apples>()}}; }
StageRole eats(const FrameOptions&) { return {.needs = {product<Apples>()}, .adds = {{{punctual_first}}}}; }

const StageType FIRST = type_of<first>("first", Slot::gather);
const StageType AGAIN = type_of<first>("again", Slot::gather);
const StageType NEAR = type_of<near_first>("near", Slot::gather);
const StageType FAR = type_of<far_first>("far", Slot::gather);
const StageType MIRROR = type_of<mirrored_first>("mirror", Slot::bounces);
const StageType HIGHER = type_of<higher>("higher", Slot::bounces);
const StageType DIRECT = type_of<direct>("direct", Slot::gather);
const StageType TREE = type_of<grows>("tree", Slot::lights);
const StageType EATER = type_of<eats>("eater", Slot::gather);

std::string refusal(std::vector<const StageType*> stages, LightPaths claims, const FrameOptions& options = {}) {
  try {
    plan_picture({"made_up", "", std::move(stages), claims}, options, LightPaths::all());
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::usage);
    return error.what();
  }
  return "";
}

#define EXPECT_SAYS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

TEST(Plan, RefusesALightPathThatIsCountedTwice) {
  EXPECT_SAYS(refusal({&FIRST, &AGAIN}, {punctual_first}), "the first reflection of punctual light: counted twice");
  EXPECT_SAYS(refusal({&FIRST, &NEAR, &FAR}, {punctual_first}), "counted twice");
  EXPECT_SAYS(refusal({&NEAR, &NEAR, &FAR}, {punctual_first}), "counted twice");
  // Every picture has this one.
  EXPECT_SAYS(refusal({&DIRECT}, {}), "direct light of punctual lights: counted twice");
}

TEST(Plan, AMirrorsShareIsBesideAllTheRest) {
  EXPECT_EQ(refusal({&FIRST, &MIRROR}, {punctual_first}), "");
  EXPECT_EQ(refusal({&NEAR, &FAR, &MIRROR}, {punctual_first}), "");
  EXPECT_SAYS(refusal({&FIRST, &MIRROR, &MIRROR}, {punctual_first}), "counted twice");
  EXPECT_SAYS(refusal({&MIRROR}, {}), "only the mirror's part is there");
  const Recipe recipe{"made_up", "", {&FIRST, &MIRROR}, {punctual_first}};
  EXPECT_TRUE(plan_picture(recipe, {}, PUNCTUAL_PATHS, true).mirror_apart);
  const Plan lambertian = plan_picture(recipe, {}, PUNCTUAL_PATHS, false);
  EXPECT_FALSE(lambertian.mirror_apart);
  EXPECT_EQ(lambertian.steps.size(), 1u);
}

TEST(Plan, RefusesALightPathThatNobodyCarries) {
  EXPECT_SAYS(refusal({&FIRST}, {punctual_first, punctual_higher}), "nobody carries higher bounces of punctual light");
  EXPECT_SAYS(refusal({}, {emission_direct}), "nobody carries light straight from emissive surfaces");
  FrameOptions one;
  one.bounces = 1;
  EXPECT_EQ(refusal({&FIRST}, {punctual_first, punctual_higher}, one), "") << "not asked for";
}

TEST(Plan, RefusesHalfOfALightPath) {
  EXPECT_SAYS(refusal({&NEAR}, {punctual_first}), "only the near part");
  EXPECT_SAYS(refusal({&FAR}, {punctual_first}), "only the far part");
  EXPECT_EQ(refusal({&NEAR, &FAR}, {punctual_first}), "");
}

TEST(Plan, RefusesLightThatTheRecipeDoesNotClaim) {
  EXPECT_SAYS(refusal({&FIRST, &HIGHER}, {punctual_first}), "stage higher adds it");
}

TEST(Plan, RefusesAStageWithoutWhatItNeeds) {
  EXPECT_SAYS(refusal({&EATER}, {punctual_first}), "stage eater needs apples");
  EXPECT_SAYS(refusal({&EATER, &TREE}, {punctual_first}), "later slot");
  EXPECT_EQ(refusal({&TREE, &EATER}, {punctual_first}), "");
}

std::vector<std::string> names(const Plan& plan) {
  std::vector<std::string> list;
  for (const Plan::Step& step : plan.steps) list.emplace_back(step.type->name);
  return list;
}

TEST(Plan, LeavesOutWhatNobodyAsksFor) {
  const Recipe recipe{"made_up", "", {&TREE, &EATER, &HIGHER}, {punctual_first, punctual_higher}};
  using Names = std::vector<std::string>;
  FrameOptions o;
  EXPECT_EQ(names(plan_picture(recipe, o, PUNCTUAL_PATHS)), (Names{"tree", "eater", "higher"}));
  o.bounces = 1;
  EXPECT_EQ(names(plan_picture(recipe, o, PUNCTUAL_PATHS)), (Names{"tree", "eater"}));
  o.bounces.reset();
  o.light = LightPart::direct;
  EXPECT_EQ(names(plan_picture(recipe, o, PUNCTUAL_PATHS)), Names{});
  o.light = LightPart::full;
  EXPECT_EQ(names(plan_picture(recipe, o, {})), Names{}) << "an empty scene";
  EXPECT_EQ(plan_picture(recipe, o, LightPaths::all()).missing,
            (LightPaths{emission_direct, emission_first, emission_higher, sky_direct, sky_first, sky_higher}));
}

TEST(Plan, EveryRecipeAddsUpWhateverIsAskedFor) {
  for (const Recipe& recipe : recipes()) {
    for (const LightPart light : {LightPart::full, LightPart::direct, LightPart::indirect}) {
      for (const std::optional<int> bounces : {std::optional<int>(), {0}, {1}, {2}}) {
        for (const LightPaths present : {LightPaths(), PUNCTUAL_PATHS, EMISSION_PATHS, LightPaths::all()}) {
          FrameOptions o;
          apply_recipe(recipe.name, o);
          o.light = light;
          o.bounces = bounces;
          if (std::string(recipe.name) == "lpv" && (bounces || light == LightPart::direct)) continue;  // below
          const Plan plan = plan_picture(recipe, o, present);
          EXPECT_TRUE((plan.wanted - present).empty()) << recipe.name;
        }
      }
    }
  }
}

/// From one recipe to another, with what the first one's name stood for.
TEST(Plan, RecipesAfterOneAnother) {
  for (const Recipe& before : recipes()) {
    for (const Recipe& after : recipes()) {
      FrameOptions o;
      apply_recipe(before.name, o);
      if (std::string(before.name) == "lpv" || std::string(after.name) == "lpv") continue;  // its scheme stays set
      apply_recipe(after.name, o);
      EXPECT_NO_THROW(plan_picture(after, o, LightPaths::all())) << before.name << " to " << after.name;
    }
  }
}

TEST(Plan, ThePapersSchemesCannotShowDirectLightOfEmissionAlone) {
  FrameOptions o;
  apply_recipe("lpv", o);
  o.light = LightPart::direct;
  EXPECT_EQ(plan_picture(find_recipe("lpv"), o, PUNCTUAL_PATHS).missing, LightPaths());
  EXPECT_EQ(plan_picture(find_recipe("lpv"), o, EMISSION_PATHS).missing, LightPaths{emission_direct});
}

TEST(Plan, LayersAreHeldToTheRole) {
  const Plan::Step step{&FIRST, {}, {{{punctual_first, emission_first}}, {{punctual_higher}, LightShare::near}}};
  const auto check = [&](std::vector<RadianceLayer> layers) { check_layers(step, layers); };
  EXPECT_NO_THROW(check({{nullptr, {punctual_first}}, {nullptr, {emission_first}}}));
  EXPECT_NO_THROW(check({})) << "no such light in this frame";
  EXPECT_THROW(check({{nullptr, {punctual_first}}, {nullptr, {punctual_first}}}), Error) << "twice";
  EXPECT_THROW(check({{nullptr, {emission_direct}}}), Error) << "another path";
  EXPECT_THROW(check({{nullptr, {punctual_higher}}}), Error) << "all of what it has a part of";
}

TEST(LightPath, AskedForByLightAndBounces) {
  EXPECT_EQ(asked_paths(LightPart::full, std::nullopt), LightPaths::all());
  EXPECT_EQ(asked_paths(LightPart::full, 0), DIRECT_PATHS);
  EXPECT_EQ(asked_paths(LightPart::indirect, 1), (LightPaths{punctual_first, emission_first, sky_first}));
  EXPECT_EQ(asked_paths(LightPart::indirect, 0), LightPaths());
  EXPECT_EQ(in_words(LightPaths{punctual_first, emission_seen}),
            "emissive surfaces seen by the camera and the first reflection of punctual light");
}

}  // namespace
}  // namespace volgi::screen
