#include "apps/demo/shader_watch.h"

#include "core/gl/shader_source.h"

namespace volgi::demo {

ShaderWatch::ShaderWatch(const std::filesystem::path& folder) : watches_(!folder.empty()) {
  if (!watches_) return;
  gl::set_shader_folder(folder);
  last_ = gl::last_shader_change();
}

bool ShaderWatch::changed() {
  constexpr auto BETWEEN = std::chrono::milliseconds(500);
  const auto now = std::chrono::steady_clock::now();
  if (!watches_ || now - looked_ < BETWEEN) return false;
  looked_ = now;
  const auto newest = gl::last_shader_change();
  if (newest == last_) return false;
  last_ = newest;
  return true;
}

}  // namespace volgi::demo
