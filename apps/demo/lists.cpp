#include "apps/demo/lists.h"

#include <fmt/format.h>

#include <string_view>

#include "apps/demo/commands.h"
#include "apps/demo/keys.h"
#include "apps/demo/view.h"
#include "core/error.h"

namespace volgi::demo {

namespace {

/// In a table's cell.
std::string code(std::string_view text) {
  if (text.empty()) return {};
  std::string out = "`";
  for (const char c : text) out += c == '|' ? std::string("\\|") : std::string(1, c);
  return out + '`';
}

}  // namespace

std::string list_of(const std::string& what) {
  std::string table;
  if (what == "keys") {
    table = "| key | does | command |\n| --- | --- | --- |\n";
    for (const KeyBinding& k : key_bindings())
      table += fmt::format("| {} | {} | {} |\n", code(k.key), k.help, code(k.command));
  } else if (what == "commands") {
    table = "| command | takes | does |\n| --- | --- | --- |\n";
    for (const Command& c : commands())
      table += fmt::format("| {} | {} | {} |\n", code(c.name), code(c.arguments), c.help);
  } else if (what == "views") {
    table = "| key | view | name | shows |\n| --- | --- | --- | --- |\n";
    for (const ViewInfo& v : views())
      table += fmt::format("| {} | {} | {} | {} |\n", code(v.key), v.title, code(v.name), v.help);
  } else {
    throw Error(ExitCode::usage, "--list " + what + ": keys, commands or views");
  }
  return table;
}

}  // namespace volgi::demo
