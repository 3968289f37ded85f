#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "core/gltf/gltf_internal.h"

namespace volgi::gltf {
namespace fs = std::filesystem;
namespace {

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// Nothing when an escape is not %XX.
std::optional<std::string> percent_decoded(const std::string& uri) {
  std::string out;
  for (size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] != '%') {
      out += uri[i];
      continue;
    }
    const int high = i + 2 < uri.size() ? hex_digit(uri[i + 1]) : -1;
    const int low = i + 2 < uri.size() ? hex_digit(uri[i + 2]) : -1;
    if (high < 0 || low < 0) return std::nullopt;
    out += char(high * 16 + low);
    i += 2;
  }
  return out;
}

bool has_scheme(const std::string& uri) {
  const size_t end = uri.find_first_of(":/?#");
  return end != std::string::npos && uri[end] == ':';
}

bool climbs(const fs::path& relative) { return std::find(relative.begin(), relative.end(), "..") != relative.end(); }

bool lies_in(const fs::path& path, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

}  // namespace

fs::path resolve_uri(const fs::path& file, const std::string& who, const std::string& uri) {
  const std::optional<std::string> decoded = percent_decoded(uri);
  if (!decoded || decoded->empty() || decoded->find('\0') != std::string::npos) {
    refuse(file, fmt::format("{} has a malformed URI '{}'", who, uri));
  }
  const fs::path relative(*decoded);
  if (has_scheme(uri) || has_scheme(*decoded) || relative.is_absolute() || climbs(relative)) {
    refuse(file, fmt::format("{}: the URI '{}' leaves the file's folder, which is not allowed", who, *decoded));
  }
  std::error_code error;
  const fs::path folder = fs::canonical(file.has_parent_path() ? file.parent_path() : fs::path("."), error);
  fs::path target = fs::weakly_canonical(folder / relative, error);
  if (error || !fs::exists(target, error)) refuse(file, fmt::format("{}: missing file '{}'", who, *decoded));
  if (!lies_in(target, folder)) {
    refuse(file, fmt::format("{}: '{}' is a link out of the file's folder, which is not allowed", who, *decoded));
  }
  if (!fs::is_regular_file(target, error)) refuse(file, fmt::format("{}: '{}' is not a file", who, *decoded));
  return target;
}

std::string tinygltf_decoded(const std::string& uri) {
  std::string spaced = uri;
  std::replace(spaced.begin(), spaced.end(), '+', ' ');
  return percent_decoded(spaced).value_or(spaced);
}

}  // namespace volgi::gltf
