#pragma once
#include <span>
#include <string>
#include <vector>

namespace volgi::app {

/// A technique parameter that --set takes, of an options struct T.
template <typename T>
struct Parameter {
  const char* name;
  const char* help;  // with the unit and, in brackets, the default
  double least, most;
  void (*set)(T&, double);
};

/// Help text: one line a parameter.
template <typename T>
std::string parameter_help(std::span<const Parameter<T>> parameters) {
  std::string text = "technique parameters NAME=VALUE:";
  for (const Parameter<T>& p : parameters) text += std::string("\n  ") + p.name + ": " + p.help;
  return text;
}

/// NAME=VALUE taken apart. @throws Error(usage) unless the value is a number.
struct NamedValue {
  std::string name;
  double value;
};
NamedValue parse_named_value(const std::string& text);
[[noreturn]] void throw_out_of_range(const std::string& text, double least, double most);
[[noreturn]] void throw_unknown_parameter(const std::string& text, const std::vector<std::string>& known);

/// Sets each NAME=VALUE. @throws Error(usage) for a name that there is not, or a value outside its range.
template <typename T>
void set_parameters(T& options, std::span<const Parameter<T>> parameters, const std::vector<std::string>& texts) {
  for (const std::string& text : texts) {
    const NamedValue given = parse_named_value(text);
    std::vector<std::string> known;
    bool found = false;
    for (const Parameter<T>& p : parameters) {
      known.emplace_back(p.name);
      if (given.name != p.name) continue;
      if (!(given.value >= p.least && given.value <= p.most)) throw_out_of_range(text, p.least, p.most);
      p.set(options, given.value);
      found = true;
    }
    if (!found) throw_unknown_parameter(text, known);
  }
}

}  // namespace volgi::app
