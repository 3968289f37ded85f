#include "apps/demo/default_scene.h"

#include <system_error>

namespace volgi::demo {

std::filesystem::path default_scene() {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path folder = program.parent_path();
  for (const fs::path& place :
       {fs::path("data/cornell.glb"), folder / "../../../data/cornell.glb", folder / "../share/volgi/cornell.glb"}) {
    if (fs::is_regular_file(place, error)) return fs::weakly_canonical(place, error);
  }
  return "builtin:metaballs";
}

}  // namespace volgi::demo
