#include <fmt/format.h>

#include "core/error.h"
#include "core/gltf/gltf_internal.h"
#include "core/log.h"
#include "core/one_line.h"

namespace volgi::gltf {
void refuse(const std::filesystem::path& file, std::string_view what) {
  throw Error(ExitCode::bad_input, fmt::format("{}: {}", file.string(), one_line(what)));
}

void warn(const std::filesystem::path& file, std::string_view what) {
  warn_once(fmt::format("{}: {}", file.string(), one_line(what)));
}

void repair(const std::filesystem::path& file, const SceneReading& reading, std::string_view what) {
  if (reading.strict) refuse(file, what);
  warn(file, what);
}

std::string element(std::string_view kind, size_t index, const std::string& name) {
  if (name.empty()) return fmt::format("{} {}", kind, index);
  return fmt::format("{} {} '{}'", kind, index, one_line(name.substr(0, 60)));
}

void check_index(const Document& document, int index, size_t size, const std::string& who, std::string_view kind) {
  if (index >= 0 && size_t(index) < size) return;
  refuse(document.path, fmt::format("{} refers to {} {}, but the file has {}", who, kind, index, size));
}

}  // namespace volgi::gltf
