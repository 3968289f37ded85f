#include "apps/demo/lists.h"

#include <fmt/format.h>

#include <string_view>

#include "apps/demo/commands.h"
#include "apps/demo/keys.h"
#include "apps/demo/view.h"
#include "apps/demo/volume_viewer.h"
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

std::string table_of(std::span<const KeyBinding> keys) {
  std::string table = "| key | does | command |\n| --- | --- | --- |\n";
  for (const KeyBinding& k : keys) table += fmt::format("| {} | {} | {} |\n", code(k.key), k.help, code(k.command));
  return table;
}

template <class AnyCommand>
std::string table_of(std::span<const AnyCommand> commands) {
  std::string table = "| command | takes | does |\n| --- | --- | --- |\n";
  for (const AnyCommand& c : commands)
    table += fmt::format("| {} | {} | {} |\n", code(c.name), code(c.arguments), c.help);
  return table;
}

}  // namespace

std::string list_of(const std::string& what) {
  std::string table;
  if (what == "keys") {
    table = table_of(key_bindings());
  } else if (what == "commands") {
    table = table_of(commands());
  } else if (what == "volume-keys") {
    table = table_of(volume_key_bindings());
  } else if (what == "volume-commands") {
    table = table_of(volume_commands());
  } else if (what == "views") {
    table = "| key | view | name | shows |\n| --- | --- | --- | --- |\n";
    for (const ViewInfo& v : views())
      table += fmt::format("| {} | {} | {} | {} |\n", code(v.key), v.title, code(v.name), v.help);
  } else {
    throw Error(ExitCode::usage, "--list " + what + ": keys, commands, views, volume-keys or volume-commands");
  }
  return table;
}

}  // namespace volgi::demo
