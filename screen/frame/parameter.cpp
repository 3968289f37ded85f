#include "screen/frame/parameter.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cmath>

#include "core/error.h"

namespace volgi::screen {

namespace {

std::optional<double> parse_number(const std::string& text) {
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (text.empty() || error != std::errc() || stop != end) return std::nullopt;
  return value;
}

std::string range_text(const Parameter& p) {
  if (!p.value_names.empty()) return fmt::format("{}", fmt::join(p.value_names, "|"));
  const std::string unit = *p.unit != '\0' ? fmt::format(" {}", p.unit) : "";
  return fmt::format("{} ... {}{}", p.least, p.most, unit);
}

}  // namespace

double parse_value(const Parameter& p, const std::string& text, const std::string& shown_as) {
  for (size_t k = 0; k < p.value_names.size(); ++k) {
    if (text == p.value_names[k]) return double(k);
  }
  const std::optional<double> value = parse_number(text);
  const bool fits = value && *value >= p.least && *value <= p.most && !(p.whole && std::floor(*value) != *value);
  if (fits) return *value;
  if (!p.value_names.empty()) {
    throw Error(ExitCode::usage,
                fmt::format("{}: needs one of {}, or its number from 0", shown_as, fmt::join(p.value_names, ", ")));
  }
  throw Error(ExitCode::usage,
              fmt::format("{}: needs a {}number from {} to {}", shown_as, p.whole ? "whole " : "", p.least, p.most));
}

std::string value_text(const Parameter& p, const TypeMap& options) {
  const std::optional<double> value = p.get(options);
  if (!value) return p.when_unset != nullptr ? p.when_unset : "unset";
  if (!p.value_names.empty()) return p.value_names[size_t(*value)];
  return fmt::format("{:g}", *value);
}

std::string help_text(const Parameter& p) {
  return fmt::format("{} [{}] ({})", p.help, range_text(p), value_text(p, TypeMap()));
}

std::string help_line(const Parameter& p) { return fmt::format("{}: {}", p.name, help_text(p)); }

}  // namespace volgi::screen
