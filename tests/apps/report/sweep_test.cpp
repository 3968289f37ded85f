#include <gtest/gtest.h>

#include <algorithm>

#include "apps/report/renderers.h"
#include "apps/report/sweep.h"
#include "apps/report/texts.h"
#include "core/error.h"

namespace volgi::app {
namespace {

using Words = std::vector<std::string>;

TEST(Sweep, OptionsReplaceTheirLike) {
  const Words options{"--grid", "32", "--set", "a=1", "--set", "b=2"};
  EXPECT_EQ(with_options(options, {"--grid", "16"}), (Words{"--grid", "16", "--set", "a=1", "--set", "b=2"}));
  EXPECT_EQ(with_options(options, {"--set", "b=3"}), (Words{"--grid", "32", "--set", "a=1", "--set", "b=3"}));
  EXPECT_EQ(with_options(options, {"--vpls", "8"}).back(), "8");
}

TEST(Sweep, VariesOneOptionAtATimeAndAddsTheOnesNamedTogether) {
  const Sweep sweep = parse_sweep(R"({"size": "8x8", "lights": ["indirect", "full"], "varied_lights": ["full"],
    "techniques": [{"name": "a", "options": "--gi hybrid --grid 32",
                    "vary": {"--grid": [16], "--set": ["x=1"]}, "also": ["--grid 8 --vpls 4"]},
                   {"name": "b", "command": "reference", "unvaried": false, "vary": {"--spp": [2, 4]}}]})",
                                  "test");
  Words labels;
  for (const Setting& setting : sweep.settings) labels.push_back(setting.label());
  EXPECT_EQ(labels, (Words{"a", "a --grid 16", "a --set x=1", "a --grid 8 --vpls 4", "b --spp 2", "b --spp 4"}));
  EXPECT_EQ(sweep.settings[3].options, (Words{"--gi", "hybrid", "--grid", "8", "--vpls", "4"}));
  EXPECT_EQ(sweep.settings[0].lights.size(), 2u);
  EXPECT_EQ(sweep.settings[1].lights, Words{"full"});
  EXPECT_EQ(sweep.settings[5].renderer, "reference");
}

TEST(Sweep, RefusesByName) {
  for (const char* text :
       {R"({"techniques": [{"name": "odd", "options": "--grid"}]})", R"({"techniques": [{"options": "--grid 4"}]})",
        R"({"techniques": [{"name": "odd"}, {"name": "odd"}]})", R"({"techniques": []})", "{", "[]",
        R"({"techniques": [{"name": "odd", "lights": ["direct"]}]})"}) {
    try {
      parse_sweep(text, "bad.json");
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::bad_input);
      EXPECT_NE(std::string(error.what()).find("bad.json"), std::string::npos) << error.what();
    }
  }
}

TEST(Sweep, TheProgramsOwnTablesAreReadAndTheirOptionsExist) {
  for (const char* name : {"full.json", "quick.json"}) {
    for (const Setting& setting : parse_sweep(report_text(name), name).settings)
      EXPECT_NO_THROW(check_options(setting.renderer, setting.options)) << setting.label();
  }
  EXPECT_GT(parse_sweep(report_text("full.json"), "full.json").settings.size(), 50u);
  const Sweep quick = parse_sweep(report_text("quick.json"), "quick.json");
  EXPECT_EQ(quick.scenes, (Words{"cornell", "room", "thin_wall", "atrium"}));
  for (const char* technique : {"hybrid", "ordinates", "vpl", "negative", "val", "path tracer"}) {
    EXPECT_TRUE(std::any_of(quick.settings.begin(), quick.settings.end(), [&](const Setting& s) {
      return s.technique == technique;
    })) << technique;
  }
}

}  // namespace
}  // namespace volgi::app
