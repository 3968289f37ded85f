// Parameters: defaults are those of the options structs, enums go by name and by the numbers that they had before.
#include "screen/frame/parameter.h"

#include <gtest/gtest.h>

#include <set>

#include "core/error.h"
#include "propagation/volume_options.h"
#include "screen/frame/registry.h"

namespace volgi::screen {
namespace {

enum class Colour { red, green };
struct Options {
  int count = 7;
  float share = 0.25f;
  bool warm = true;
  Colour colour = Colour::green;
  std::optional<int> passes;
};
constexpr const char* COLOURS[] = {"red", "green"};
constexpr Parameter COUNT = number<Options>(
    {"a.count", "pixels", "so many"}, {1, 9}, [](Options& o) -> auto& { return o.count; });
constexpr Parameter SHARE = number<Options>(
    {"a.share", "", "a part"}, {0, 1}, [](Options& o) -> auto& { return o.share; });
constexpr Parameter WARM = yes_no<Options>(
    {"a.warm", "", "warm"}, [](Options& o) -> auto& { return o.warm; });
constexpr Parameter COLOUR = choice<Options>(
    {"a.colour", "", "which"}, COLOURS, [](Options& o) -> auto& { return o.colour; });
constexpr Parameter PASSES = number<Options>(
    {"a.passes", "passes", "at most", "until done"}, {1, 9}, [](Options& o) -> auto& { return o.passes; });

void set(TypeMap& options, const Parameter& p, const std::string& text) {
  p.set(options, parse_value(p, text, p.name));
}

TEST(Parameter, ReadsDefaultsFromTheStruct) {
  EXPECT_EQ(help_line(COUNT), "a.count: so many [1 ... 9 pixels] (7)");
  EXPECT_EQ(help_line(SHARE), "a.share: a part [0 ... 1] (0.25)");
  EXPECT_EQ(help_line(WARM), "a.warm: warm [off|on] (on)");
  EXPECT_EQ(help_line(COLOUR), "a.colour: which [red|green] (green)");
  EXPECT_EQ(help_line(PASSES), "a.passes: at most [1 ... 9 passes] (until done)");
}

TEST(Parameter, SetsByNumberAndByName) {
  TypeMap o;
  set(o, COUNT, "3");
  set(o, SHARE, "0.5");
  set(o, WARM, "0");
  set(o, COLOUR, "red");
  set(o, PASSES, "4");
  EXPECT_EQ(o.of<Options>().count, 3);
  EXPECT_EQ(o.of<Options>().share, 0.5f);
  EXPECT_FALSE(o.of<Options>().warm);
  EXPECT_EQ(o.of<Options>().colour, Colour::red);
  EXPECT_EQ(o.of<Options>().passes, 4);
  set(o, WARM, "on");
  set(o, COLOUR, "1");
  EXPECT_TRUE(o.of<Options>().warm);
  EXPECT_EQ(value_text(COLOUR, o), "green");
}

TEST(Parameter, RefusesWhatItDoesNotTake) {
  TypeMap o;
  for (const char* text : {"0", "10", "2.5", "nan", "", "3x", "green"})
    EXPECT_THROW(set(o, COUNT, text), Error) << text;
  for (const char* text : {"2", "-1", "0.5", "blue"}) EXPECT_THROW(set(o, COLOUR, text), Error) << text;
  EXPECT_THROW(set(o, SHARE, "1.01"), Error);
}

TEST(Registry, EveryParameterTakesItsOwnDefault) {
  std::set<std::string> names;
  for (const Parameter* p : parameters()) {
    EXPECT_TRUE(names.insert(p->name).second) << p->name << " is there twice";
    const TypeMap unset;
    const auto before = p->get(unset);
    if (!before) {
      EXPECT_NE(p->when_unset, nullptr) << p->name;
      continue;
    }
    TypeMap o;
    set_parameter(o, std::string(p->name) + "=" + value_text(*p, unset));
    EXPECT_EQ(p->get(o), before) << p->name;
  }
}

TEST(Registry, OldNumbersOfEnumsAreStillTaken) {
  TypeMap by_number, by_name;
  for (const auto& [number, name] : {std::pair("vpl.flux=1", "vpl.flux=flux"),
                                     {"negative.method=0", "negative.method=cochran2007"},
                                     {"val.shadow=0", "val.shadow=convolution"},
                                     {"val.shadow=2", "val.shadow=single"},
                                     {"ordinates.characteristic=1", "ordinates.characteristic=characteristic"},
                                     {"solver.cg=0", "solver.cg=plain"},
                                     {"solver.warm=1", "solver.warm=on"}}) {
    set_parameter(by_number, number);
    set_parameter(by_name, name);
    for (const Parameter* p : parameters()) EXPECT_EQ(p->get(by_number), p->get(by_name)) << number;
  }
}

TEST(Registry, NamesWhatThereIs) {
  try {
    TypeMap o;
    set_parameter(o, "nonsense=1");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("val.map"), std::string::npos) << error.what();
  }
  EXPECT_THROW(find_recipe("magic"), Error);
}

TEST(Registry, TakesTheFirstRecipeThatTheSettingsAllow) {
  FrameOptions o;
  EXPECT_STREQ(default_recipe(o).name, "hybrid");
  o.of<VolumeOptions>().scheme.scheme = Scheme::gaitatzes2010;
  EXPECT_STREQ(default_recipe(o).name, "volume");
}

TEST(Registry, LeavesStagesOut) {
  FrameOptions o;
  apply_recipe("negative", o);
  o.without = {"visibility/negative"};
  const Recipe without = recipe_of(o);
  EXPECT_EQ(without.stages.size() + 1, find_recipe("negative").stages.size());
  EXPECT_EQ(without.claims, find_recipe("negative").claims);  // it took light away, and added none
  o.without = {"gather/strided"};
  EXPECT_FALSE(recipe_of(o).claims.contains(LightPath::punctual_first));
  o.without = {"bounces/volume"};
  EXPECT_THROW(recipe_of(o), Error);
}

TEST(Registry, AParameterGoesBackToUnset) {
  TypeMap o, fresh;
  const Parameter& p = find_parameter("vpl.per_light");
  set_parameter(o, "vpl.per_light=7");
  ASSERT_TRUE(p.get(o));
  p.copy(fresh, o);
  EXPECT_FALSE(p.get(o));
}

}  // namespace
}  // namespace volgi::screen
