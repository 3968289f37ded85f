#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace volgi::app {

/// Text for HTML, between tags and in quoted attributes.
std::string escaped(std::string_view text);
/// A file as a data: URI of type image/png; empty when it cannot be read.
std::string png_data_uri(const std::filesystem::path& path);
/// Three significant digits, without exponent from 0.001 to 100,000: "0.0312", "4.56", "123".
std::string figure(double value);
/// "4.56 %"
std::string percent(double value);

}  // namespace volgi::app
