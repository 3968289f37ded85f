#pragma once
// Words of a command's line.
#include <fmt/format.h>

#include <algorithm>
#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "apps/volgi/light_options.h"
#include "apps/volgi/parse_number.h"
#include "core/error.h"

namespace volgi::demo {

[[noreturn]] inline void misused(const std::string& what) { throw Error(ExitCode::usage, what); }

inline double number(const std::string& text, const char* what) {
  const auto value = app::parse_number<double>(text);
  if (!value) misused(fmt::format("'{}': {} is a number", text, what));
  return *value;
}

inline int whole(const std::string& text, const char* what, int least, int most) {
  const auto value = app::parse_number<int>(text);
  if (!value || *value < least || *value > most)
    misused(fmt::format("'{}': {} is a whole number from {} to {}", text, what, least, most));
  return *value;
}

inline glm::dvec3 three(const std::string& text, const char* what) {
  const std::vector<double> v = app::parse_numbers(text);
  if (v.size() != 3) misused(fmt::format("'{}': {} is X,Y,Z", text, what));
  return {v[0], v[1], v[2]};
}

/// The first word, and the rest.
inline std::pair<std::string, std::string> split(std::string_view text) {
  const size_t start = std::min(text.find_first_not_of(' '), text.size());
  text.remove_prefix(start);
  const size_t end = std::min(text.find(' '), text.size());
  std::string_view rest = text.substr(end);
  rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
  while (rest.ends_with(' ')) rest.remove_suffix(1);
  return {std::string(text.substr(0, end)), std::string(rest)};
}

}  // namespace volgi::demo
