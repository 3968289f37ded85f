#include "core/gl/shader_source.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <vector>

#include "core/error.h"

namespace volgi::gl {
namespace {

constexpr std::string_view legend_mark = "//file ";

std::filesystem::path& shader_folder() {
  static std::filesystem::path folder;
  return folder;
}

const ShaderFile* find_file(std::string_view name) {
  const auto files = shader_files();
  const auto it = std::find_if(files.begin(), files.end(), [&](const ShaderFile& f) { return f.name == name; });
  return it == files.end() ? nullptr : &*it;
}

/// The folder's text where it has such a file.
std::string text_of(const ShaderFile& file) {
  if (!shader_folder().empty()) {
    std::ifstream in(shader_folder() / file.name, std::ios::binary);
    if (in) return {std::istreambuf_iterator<char>(in), {}};
  }
  return std::string(file.text);
}

std::string_view take_line(std::string_view& text) {
  const size_t end = std::min(text.find('\n'), text.size());
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return line;
}

/// The name in `#include "name"`; empty when the line is none, "<" when it includes a C++ header.
std::string_view included_name(std::string_view line) {
  const size_t start = line.find_first_not_of(" \t");
  constexpr std::string_view directive = "#include";
  if (start == std::string_view::npos || !line.substr(start).starts_with(directive)) return {};
  const size_t open = line.find('"', start);
  if (open == std::string_view::npos) return "<";
  return line.substr(open + 1, line.find('"', open + 1) - open - 1);
}

class Expansion {
 public:
  explicit Expansion(std::string_view after_version) : after_version_(after_version) {}

  std::string run(std::string_view name) {
    append(name, {});
    return std::move(out_);
  }

 private:
  void append(std::string_view name, std::string_view includer) {
    const ShaderFile* file = find_file(name);
    if (file == nullptr) {
      throw Error(ExitCode::no_device, "shader file " + std::string(name) + " is not embedded" +
                                           (includer.empty() ? "" : " (included by " + std::string(includer) + ")") +
                                           "; rebuild the library with it under shaders/");
    }
    const size_t number = done_.size();
    done_.push_back(file->name);  // `name` may lie in a text that is gone when the next file asks
    const std::string text = text_of(*file);
    std::string_view rest = text;
    if (includer.empty()) {
      out_ += std::string(take_line(rest)) + '\n' + std::string(after_version_);
    }
    out_ += std::string(legend_mark) + std::to_string(number) + ' ' + std::string(name) + '\n';
    int line_number = includer.empty() ? 2 : 1;
    mark(line_number, number);
    while (!rest.empty()) {
      const std::string_view line = take_line(rest);
      ++line_number;
      const std::string_view included = included_name(line);
      if (included.empty()) {
        out_.append(line).push_back('\n');
      } else if (included == "<" || std::find(done_.begin(), done_.end(), included) != done_.end()) {
        out_.push_back('\n');
      } else {
        append(included, name);
        mark(line_number, number);
      }
    }
  }

  void mark(int line, size_t file) { out_ += "#line " + std::to_string(line) + ' ' + std::to_string(file) + '\n'; }

  std::string_view after_version_;
  std::vector<std::string_view> done_;
  std::string out_;
};

}  // namespace

bool has_shader_file(std::string_view name) { return find_file(name) != nullptr; }

void set_shader_folder(const std::filesystem::path& folder) {
  if (!folder.empty() && !std::filesystem::is_directory(folder))
    throw Error(ExitCode::usage, "--shaders " + folder.string() + ": no such folder");
  shader_folder() = folder;
}

std::filesystem::file_time_type last_shader_change() {
  if (shader_folder().empty()) return {};
  auto last = std::filesystem::file_time_type::min();  // the epoch may be to come: GCC's is in 2174
  for (const ShaderFile& file : shader_files()) {
    std::error_code error;
    const auto time = std::filesystem::last_write_time(shader_folder() / file.name, error);
    if (!error) last = std::max(last, time);
  }
  return last;
}

std::string expand_shader(std::string_view name, std::string_view after_version) {
  return Expansion(after_version).run(name);
}

std::string file_legend(std::string_view expanded) {
  std::string legend;
  while (!expanded.empty()) {
    const std::string_view line = take_line(expanded);
    if (!line.starts_with(legend_mark)) continue;
    if (!legend.empty()) legend += ", ";
    legend += line.substr(legend_mark.size());
  }
  return legend;
}

}  // namespace volgi::gl
