// volgi_expand_shaders DIR: writes every stage file (*.STAGE.glsl) with its includes expanded, for glslangValidator.
#include <filesystem>
#include <fstream>
#include <iostream>

#include "core/gl/shader_source.h"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    const std::filesystem::path folder = argv[1];
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    for (const volgi::gl::ShaderFile& file : volgi::gl::shader_files()) {
      const std::filesystem::path name(file.name);
      if (name.extension() != ".glsl" || !name.stem().has_extension()) continue;  // a part, included by others
      std::filesystem::create_directories((folder / name).parent_path());
      std::ofstream out(folder / name);
      out << volgi::gl::expand_shader(file.name);
      if (!out) throw std::runtime_error("cannot write " + (folder / name).string());
    }
  } catch (const std::exception& error) {
    std::cerr << "volgi_expand_shaders: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
