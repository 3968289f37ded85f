#pragma once
#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>

namespace volgi {

/// A text of a file's for a message: it may hold line breaks, escape sequences or megabytes.
inline std::string one_line(std::string_view text) {
  constexpr size_t longest = 300;
  std::string line(text.substr(0, longest));
  std::replace_if(
      line.begin(), line.end(), [](char c) { return std::uint8_t(c) < 32 || c == 127; }, ' ');
  if (text.size() > longest) line += "...";
  return line;
}

}  // namespace volgi
