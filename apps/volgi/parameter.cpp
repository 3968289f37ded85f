#include "apps/volgi/parameter.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>

#include "core/error.h"

namespace volgi::app {

NamedValue parse_named_value(const std::string& text) {
  const size_t equals = text.find('=');
  double value = 0.0;
  const char* end = text.data() + text.size();
  const char* begin = equals == std::string::npos ? end : text.data() + equals + 1;
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (begin == end || error != std::errc() || stop != end) {
    throw Error(ExitCode::usage, fmt::format("--set {}: give NAME=VALUE with a number, such as grid.shift=0.25", text));
  }
  return {text.substr(0, equals), value};
}

void throw_out_of_range(const std::string& text, double least, double most) {
  throw Error(ExitCode::usage, fmt::format("--set {}: needs a number from {} to {}", text, least, most));
}

void throw_unknown_parameter(const std::string& text, const std::vector<std::string>& known) {
  throw Error(ExitCode::usage, fmt::format("--set {}: no such parameter; there are {}", text, fmt::join(known, ", ")));
}

}  // namespace volgi::app
