#pragma once
#include <filesystem>
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

/// From here on, files below this folder are read in place of embedded ones of the same name, each time anew; what is
/// not there is taken as embedded. Empty: all as embedded. For work on shaders (volgi-demo --shaders).
/// @throws Error(usage) when it is no folder.
void set_shader_folder(const std::filesystem::path& folder);
/// Of its files, the last change; its epoch where none is set.
std::filesystem::file_time_type last_shader_change();

/// The text of an embedded shader file: `#include "..."` expanded, each file once; #line gives file numbers, which
/// comments "//file NUMBER NAME" explain.
/// @param after_version lines put behind #version.
/// @throws Error(no_device) naming the file when it or one that it includes is not embedded.
std::string expand_shader(std::string_view name, std::string_view after_version = {});

/// "0 screen/base/gbuffer.frag.glsl, 1 shared/material.glsl": which file the numbers of a compiler's message mean.
std::string file_legend(std::string_view expanded);

}  // namespace volgi::gl
