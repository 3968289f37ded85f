#include "tests/support/hard_case.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/support/paths.h"

namespace volgi::test {
namespace {

using Json = nlohmann::json;

std::string key_of(const std::string& row, const std::string& what, const std::string& on) {
  return row + " | " + what + " | " + on;
}

const std::map<std::string, Json>& page() {
  static const std::map<std::string, Json> figures = [] {
    std::map<std::string, Json> found;
    std::ifstream file(source_dir() / "docs/results/hard-cases.json");
    const Json json = Json::parse(file, nullptr, false);
    if (json.is_discarded()) return found;
    for (const Json& f : json["figures"]) found[key_of(f["row"], f["what"], f["on"])] = f;
    return found;
  }();
  return figures;
}

void write(const HardCase& f, const std::string& folder) {
  const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
  Json line = {{"row", f.row},
               {"what", f.what},
               {"on", f.on},
               {"measured", f.measured},
               {"limit", f.limit},
               {"unit", f.unit},
               {"test", std::string(test.test_suite_name()) + "." + test.name()}};
  if (f.asked) line["asked"] = *f.asked;
  if (!f.cause.empty()) line["cause"] = f.cause;
  std::ofstream(folder + "/" + std::to_string(getpid()) + ".jsonl", std::ios::app) << line.dump() << '\n';
}

void compare(const HardCase& f, bool comparable) {
  const std::string key = key_of(f.row, f.what, f.on);
  const auto found = page().find(key);
  if (found == page().end()) {
    ADD_FAILURE() << key << ": not in docs/results/hard-cases.json; ./run hardcases writes it";
    return;
  }
  const Json& on_page = found->second;
  EXPECT_EQ(on_page["limit"].get<double>(), f.limit) << key << ": another limit than on the page";
  EXPECT_EQ(on_page.value("asked", f.limit), f.asked.value_or(f.limit)) << key << ": the page asks for another limit";
  if (comparable) {
    EXPECT_NEAR(on_page["measured"].get<double>(), f.measured, 0.1 * f.limit)
        << key << ": another figure than on the page";
  }
}

}  // namespace

void expect_hard_case(const HardCase& f, bool comparable) {
  EXPECT_LE(f.measured, f.limit) << f.row << ", " << f.what;
  EXPECT_EQ(f.limit > f.asked.value_or(f.limit), !f.cause.empty()) << f.row << ", " << f.what << ": a cause is missing";
  const char* folder = std::getenv("VOLGI_HARD_CASES");
  if (folder != nullptr) {
    write(f, folder);
  } else {
    compare(f, comparable);
  }
}

}  // namespace volgi::test
