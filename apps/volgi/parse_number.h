#pragma once
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

namespace volgi::app {

/// The whole text as a finite number; none when it is anything else.
template <typename Number>
std::optional<Number> parse_number(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  if (!std::isfinite(double(number))) return std::nullopt;
  return number;
}

}  // namespace volgi::app
