#include "apps/volgi/program_help.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cctype>
#include <string_view>
#include <vector>

#include "core/atomic_file.h"
#include "core/error.h"

namespace volgi::app {

namespace {

namespace fs = std::filesystem;
using Options = std::vector<const CLI::Option*>;
using Programs = std::vector<const CLI::App*>;

Programs commands_of(const CLI::App& program) {
  return program.get_subcommands([](const CLI::App* command) { return !command->get_group().empty(); });
}

/// What --help shows.
Options options_of(const CLI::App& command) {
  return command.get_options([](const CLI::Option* option) { return !option->get_group().empty(); });
}

bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

/// "-o", "--output".
std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

/// "FILE", "INT in [1 - 9]"; empty for a flag.
std::string value_of(const CLI::Option& option) { return takes_value(option) ? option.get_type_name() : ""; }

/// Words that a value can be, where its type lists them: "full|direct|indirect", "{a,b}", "EV|auto".
std::vector<std::string> choices_of(const CLI::Option& option) {
  std::string text = value_of(option);
  const size_t open = text.find('{'), close = text.find('}');
  if (open != std::string::npos && close != std::string::npos) {
    text = text.substr(open + 1, close - open - 1);
    std::replace(text.begin(), text.end(), ',', '|');
  } else if (text.find('|') == std::string::npos) {
    return {};
  }
  std::vector<std::string> words;
  const auto is_word = [](const std::string& word) {
    const auto of_word = [](unsigned char c) { return std::islower(c) || std::isdigit(c) || c == '_' || c == '-'; };
    return !word.empty() && std::all_of(word.begin(), word.end(), of_word);
  };
  for (size_t at = 0; at <= text.size();) {
    const size_t end = std::min(text.find('|', at), text.size());
    if (is_word(text.substr(at, end - at))) words.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return words;
}

void write_text(const fs::path& path, const std::string& text) {
  std::error_code error;
  fs::create_directories(path.parent_path(), error);
  write_text_atomically(path, text);
}

// --- manual pages ---------------------------------------------------------------------------------------------------

/// Text that is no request and has no escapes.
std::string roff(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const bool starts_line = out.empty() || out.back() == '\n';
    if (starts_line && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
  }
  return out;
}

std::string upper(std::string text) {
  for (char& c : text) c = char(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

std::string manual_option(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : names_of(option)) names.push_back("\\fB" + roff(name) + "\\fR");
  std::string head =
      names.empty() ? "\\fI" + roff(option.get_name(true)) + "\\fR" : fmt::format("{}", fmt::join(names, ", "));
  if (!names.empty() && takes_value(option)) head += " \\fI" + roff(value_of(option)) + "\\fR";
  std::string text = ".TP\n" + head + "\n" + roff(option.get_description());
  if (!option.get_default_str().empty()) text += roff(fmt::format(" [{}]", option.get_default_str()));
  return text + "\n";
}

std::string manual_page(const CLI::App& command, const std::string& name, const std::string& version,
                        const Programs& commands, const std::string& parent) {
  std::string page = fmt::format(".TH {} 1 \"\" \"{}\" \"volgi\"\n.SH NAME\n{} \\- {}\n", upper(roff(name)), version,
                                 roff(name), roff(command.get_description()));
  page += ".SH SYNOPSIS\n.B " + roff(parent.empty() ? name : parent + " " + command.get_name()) + "\n";
  page += commands.empty() ? "[\\fIOPTION\\fR ...]" : "\\fICOMMAND\\fR [\\fIOPTION\\fR ...]";
  std::string positional, named;
  for (const CLI::Option* option : options_of(command)) {
    if (option->get_positional()) page += " [\\fI" + roff(option->get_name(true)) + "\\fR]";
    (option->get_positional() ? positional : named) += manual_option(*option);
  }
  page += "\n";
  if (!positional.empty()) page += ".SH ARGUMENTS\n" + positional;
  if (!commands.empty()) page += ".SH COMMANDS\n";
  for (const CLI::App* each : commands)
    page +=
        fmt::format(".TP\n.BR {}\\-{} (1)\n{}\n", roff(name), roff(each->get_name()), roff(each->get_description()));
  page += ".SH OPTIONS\n" + named;
  if (!command.get_footer().empty()) page += ".SH NOTES\n.nf\n" + roff(command.get_footer()) + "\n.fi\n";
  return page + (parent.empty() ? "" : ".SH SEE ALSO\n.BR " + roff(parent) + " (1)\n");
}

// --- bash -----------------------------------------------------------------------------------------------------------

/// Words of one command: its options, and those of their values that are listed.
std::string bash_cases(const CLI::App& command, const std::string& name) {
  std::string cases, all;
  for (const CLI::Option* option : options_of(command)) {
    const std::vector<std::string> names = names_of(*option);
    all += fmt::format("{}{}", all.empty() || names.empty() ? "" : " ", fmt::join(names, " "));
    if (names.empty() || !takes_value(*option)) continue;
    std::vector<std::string> patterns;
    patterns.reserve(names.size());
    for (const std::string& each : names) patterns.push_back(fmt::format("{}:{}", name, each));
    const std::vector<std::string> choices = choices_of(*option);
    // What is not listed may be a file's name: bash's own completion goes on.
    cases += fmt::format("    {})\n      COMPREPLY=({})\n      return\n      ;;\n", fmt::join(patterns, " | "),
                         choices.empty() ? "" : fmt::format("$(compgen -W '{}' -- \"$cur\")", fmt::join(choices, " ")));
  }
  return cases + fmt::format("    {}:*) options='{}' ;;\n", name, all);
}

std::string bash_completion(const CLI::App& program, const Programs& commands) {
  const std::string& name = program.get_name();
  std::string function = "_" + name;
  std::replace(function.begin(), function.end(), '-', '_');
  std::vector<std::string> names;
  for (const CLI::App* command : commands) names.push_back(command->get_name());
  std::string text = fmt::format(
      "# bash completion for {0}, from its option tables\n{1}() {{\n"
      "  local cur=${{COMP_WORDS[COMP_CWORD]}} prev=${{COMP_WORDS[COMP_CWORD - 1]}} command= options= word\n"
      "  COMPREPLY=()\n",
      name, function);
  if (!names.empty())
    text += fmt::format(
        "  for word in \"${{COMP_WORDS[@]:1:COMP_CWORD-1}}\"; do\n    case $word in\n"
        "      {}) command=$word && break ;;\n    esac\n  done\n",
        fmt::join(names, " | "));
  text += "  case $command:$prev in\n";
  for (const CLI::App* command : commands) text += bash_cases(*command, command->get_name());
  text += bash_cases(program, "") + "  esac\n";
  text += "  if [[ $cur == -* ]]; then\n    COMPREPLY=($(compgen -W \"$options\" -- \"$cur\"))\n";
  if (!names.empty())
    text += fmt::format("  elif [[ -z $command ]]; then\n    COMPREPLY=($(compgen -W '{}' -- \"$cur\"))\n",
                        fmt::join(names, " "));
  return text + fmt::format("  fi\n}}\ncomplete -o default -F {} {}\n", function, name);
}

// --- zsh ------------------------------------------------------------------------------------------------------------

/// Between single quotes, within the brackets or colons of _arguments.
std::string zsh_text(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '\'')
      out += "'\\''";
    else if (c == '\n')
      out += ' ';
    else if (c == '[' || c == ']' || c == ':' || c == '\\')
      out += std::string("\\") + c;
    else
      out += c;
  }
  return out;
}

std::string zsh_arguments(const CLI::App& command, const char* indent) {
  std::string text = "_arguments -s";
  for (const CLI::Option* option : options_of(command)) {
    for (const std::string& name : names_of(*option)) {
      text += fmt::format(" \\\n{}'*{}[{}]", indent, name, zsh_text(option->get_description()));
      const std::vector<std::string> choices = choices_of(*option);
      if (takes_value(*option))
        text += fmt::format(":{}:{}", zsh_text(value_of(*option)),
                            choices.empty() ? "_files" : fmt::format("({})", fmt::join(choices, " ")));
      text += "'";
    }
  }
  return text + fmt::format(" \\\n{}'*:file:_files'\n", indent);
}

std::string zsh_completion(const CLI::App& program, const Programs& commands) {
  const std::string& name = program.get_name();
  std::string text = fmt::format("#compdef {}\n# from its option tables\n", name);
  if (commands.empty()) return text + zsh_arguments(program, "  ");
  text += "local -a commands\ncommands=(\n";
  for (const CLI::App* command : commands)
    text += fmt::format("  '{}:{}'\n", command->get_name(), zsh_text(command->get_description()));
  text += ")\nif ((CURRENT == 2)); then\n  _describe command commands\n  _arguments -s";
  for (const CLI::Option* option : options_of(program)) {
    for (const std::string& each : names_of(*option))
      text += fmt::format(" '{}[{}]'", each, zsh_text(option->get_description()));
  }
  text += "\n  return\nfi\nshift words\n((CURRENT--))\ncase $words[1] in\n";
  for (const CLI::App* command : commands)
    text += fmt::format("  {})\n    {}    ;;\n", command->get_name(), zsh_arguments(*command, "      "));
  return text + "esac\n";
}

}  // namespace

void write_program_help(const CLI::App& program, const std::string& version, const fs::path& folder) {
  const Programs commands = commands_of(program);
  const std::string& name = program.get_name();
  write_text(folder / "man1" / (name + ".1"), manual_page(program, name, version, commands, ""));
  for (const CLI::App* command : commands) {
    const std::string whole = name + "-" + command->get_name();
    write_text(folder / "man1" / (whole + ".1"), manual_page(*command, whole, version, {}, name));
  }
  write_text(folder / "bash" / name, bash_completion(program, commands));
  write_text(folder / "zsh" / ("_" + name), zsh_completion(program, commands));
}

bool wrote_program_help(const CLI::App& program, const std::string& version, int argc, char** argv) {
  if (argc != 3 || std::string_view(argv[1]) != "--write-help") return false;
  write_program_help(program, version, argv[2]);
  return true;
}

}  // namespace volgi::app
