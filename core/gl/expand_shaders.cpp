// volgi_expand_shaders DIR: writes every stage file (*.STAGE.glsl) with its includes expanded, for glslangValidator.
// What the program defines when it compiles the shader, the file says in lines "// Set by the program: NAME = VALUE";
// the value is an example.
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>

#include "core/gl/shader_source.h"

namespace {

std::string example_defines(std::string_view text) {
  constexpr std::string_view mark = "// Set by the program: ";
  std::string defines;
  for (size_t at = text.find(mark); at != std::string_view::npos; at = text.find(mark, at + 1)) {
    const std::string_view line = text.substr(at, text.find('\n', at) - at).substr(mark.size());
    const size_t equals = line.find(" = ");
    if (equals == std::string_view::npos) continue;
    defines += "#define " + std::string(line.substr(0, equals)) + ' ' + std::string(line.substr(equals + 3)) + '\n';
  }
  return defines;
}

}  // namespace

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
      out << volgi::gl::expand_shader(file.name, example_defines(file.text));
      if (!out) throw std::runtime_error("cannot write " + (folder / name).string());
    }
  } catch (const std::exception& error) {
    std::cerr << "volgi_expand_shaders: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
