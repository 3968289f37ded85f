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

bool has_scheme(const std::string& uri) {
  const size_t end = uri.find_first_of(":/?#");
  return end != std::string::npos && uri[end] == ':';
}

bool lies_in(const fs::path& path, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

/// A file whose name holds what looks like an escape; one of a folder written with backslashes; one with a query, as
/// browsers find it.
std::optional<fs::path> by_other_names(const fs::path& folder, const fs::path& root, const std::string& uri,
                                       const std::string& decoded) {
  std::string slashed = decoded;
  std::replace(slashed.begin(), slashed.end(), '\\', '/');
  for (const std::string& name : {uri, slashed, slashed.substr(0, slashed.find_first_of("?#"))}) {
    std::error_code error;
    const fs::path written = (folder / fs::path(name)).lexically_normal();
    if (name == decoded || !lies_in(written, root) || !fs::is_regular_file(written, error)) continue;
    const fs::path target = fs::weakly_canonical(written, error);
    if (!error && lies_in(target, root)) return target;
  }
  return std::nullopt;
}

}  // namespace

bool is_elsewhere(const std::string& uri) { return uri.empty() || uri[0] == '/' || has_scheme(uri); }

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

std::optional<fs::path> resolve_uri(const fs::path& file, const SceneReading& reading, const std::string& who,
                                    const std::string& uri) {
  // Names are written raw, too: what is no escape stands for itself.
  const std::string decoded = percent_decoded(uri).value_or(uri);
  if (decoded.empty() || decoded.find('\0') != std::string::npos)
    refuse(file, fmt::format("{} has a malformed URI '{}'", who, uri));
  const fs::path relative(decoded);
  if (is_elsewhere(uri) || relative.is_absolute())
    refuse(file, fmt::format("{}: the URI '{}' leaves the file's folder, which is not allowed", who, decoded));
  std::error_code error;
  const fs::path folder = fs::canonical(file.has_parent_path() ? file.parent_path() : fs::path("."), error);
  const fs::path root = reading.root.empty() ? folder : fs::canonical(reading.root, error);
  if (error) refuse(file, fmt::format("--root {}: there is no such folder", reading.root.string()));
  // Without links first: what is outside is not even looked for.
  const fs::path written = (folder / relative).lexically_normal();
  const bool outside = !lies_in(written, root);
  fs::path target = outside ? written : fs::weakly_canonical(written, error);
  if (outside || !lies_in(target, root)) {
    refuse(file, fmt::format("{}: '{}' leads out of {}, which is not allowed; --root FOLDER allows more", who, decoded,
                             reading.root.empty() ? "the file's folder" : "the root folder"));
  }
  if (error || !fs::exists(target, error)) {
    const std::optional<fs::path> other = by_other_names(folder, root, uri, decoded);
    if (!other) return std::nullopt;
    target = *other;
  }
  if (!fs::is_regular_file(target, error)) refuse(file, fmt::format("{}: '{}' is not a file", who, decoded));
  return target;
}

}  // namespace volgi::gltf
