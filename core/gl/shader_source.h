#pragma once
#include <span>
#include <string>
#include <string_view>

namespace volgi::gl {

/// A file under shaders/, as embedded at build time.
struct ShaderFile {
  std::string_view name;  // relative to shaders/: "screen/base/gbuffer.frag.glsl"
  std::string_view text;
};
std::span<const ShaderFile> shader_files();
bool has_shader_file(std::string_view name);

/// The text of an embedded shader file: `#include "..."` expanded, each file once; #line gives file numbers, which
/// comments "//file NUMBER NAME" explain.
/// @param after_version lines put behind #version.
/// @throws Error(no_device) naming the file when it or one that it includes is not embedded.
std::string expand_shader(std::string_view name, std::string_view after_version = {});

/// "0 screen/base/gbuffer.frag.glsl, 1 shared/material.glsl": which file the numbers of a compiler's message mean.
std::string file_legend(std::string_view expanded);

}  // namespace volgi::gl
