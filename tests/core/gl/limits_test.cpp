// core/gl: limits are compared and named, and cover what shaders declare; slots have names.
#include "core/gl/limits.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <regex>
#include <set>

#include "core/gl/shader_source.h"
#include "tests/support/gl_test.h"

namespace volgi::test {
namespace {

TEST(Limits, NameWhatFallsShort) {
  constexpr std::array needed{gl::Limit{GL_MAX_IMAGE_UNITS, "GL_MAX_IMAGE_UNITS", 4, "screen/a"},
                              gl::Limit{GL_MAX_UNIFORM_BLOCK_SIZE, "GL_MAX_UNIFORM_BLOCK_SIZE", 65536, "screen/b"}};
  const auto shortage = [&](GLint64 block) {
    return gl::first_shortage(needed, [&](GLenum name) { return name == GL_MAX_IMAGE_UNITS ? GLint64(4) : block; });
  };
  EXPECT_EQ(shortage(65536), "");
  EXPECT_EQ(shortage(16384), "GL_MAX_UNIFORM_BLOCK_SIZE is 16384, and screen/b needs 65536");
}

/// What GL 4.5 promises would not do: such a driver is refused by name.
TEST(Limits, OfThePromisedMinimumAreNotEnough) {
  const std::string shortage = gl::first_shortage(gl::needed_limits(), [](GLenum name) -> GLint64 {
    switch (name) {
      case GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS:
        return 8;
      default:
        return 1 << 20;
    }
  });
  EXPECT_EQ(shortage.find("GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS is 8"), 0u) << shortage;
}

GLint64 need_of(GLenum name) {
  for (const gl::Limit& limit : gl::needed_limits()) {
    if (limit.name == name) return limit.need;
  }
  ADD_FAILURE() << "not in the table: " << name;
  return 0;
}

/// Sums and products of numbers and of what a text defines.
class Constants {
 public:
  explicit Constants(const std::string& text) {
    static const std::regex define(R"(#define (\w+) +([^/\n]+))");
    for (std::sregex_iterator it(text.begin(), text.end(), define), none; it != none; ++it) {
      values_.emplace((*it)[1], (*it)[2]);
    }
  }
  int value(const std::string& expression) const {
    std::string_view rest = expression;
    const int v = sum(rest);
    EXPECT_TRUE(rest.empty()) << "what is " << expression << "?";
    return v;
  }

 private:
  int sum(std::string_view& rest) const {
    int v = product(rest);
    while (take(rest, '+')) v += product(rest);
    return v;
  }
  int product(std::string_view& rest) const {
    int v = one(rest);
    while (take(rest, '*')) v *= one(rest);
    return v;
  }
  int one(std::string_view& rest) const {
    if (take(rest, '(')) {
      const int v = sum(rest);
      EXPECT_TRUE(take(rest, ')'));
      return v;
    }
    size_t end = 0;
    while (end < rest.size() && (std::isalnum(static_cast<unsigned char>(rest[end])) || rest[end] == '_')) ++end;
    const std::string word(rest.substr(0, end));
    rest.remove_prefix(end);
    skip_blanks(rest);
    if (!word.empty() && std::isdigit(static_cast<unsigned char>(word[0]))) return std::stoi(word);
    const auto known = values_.find(word);
    if (known == values_.end()) {
      ADD_FAILURE() << '"' << word << "\" is not defined";
      return 0;
    }
    return value(known->second);
  }
  static bool take(std::string_view& rest, char what) {
    skip_blanks(rest);
    if (rest.empty() || rest[0] != what) return false;
    rest.remove_prefix(1);
    skip_blanks(rest);
    return true;
  }
  static void skip_blanks(std::string_view& rest) {
    rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
  }

  std::map<std::string, std::string> values_;
};

/// Slots of one kind. Variants of a shader may declare other things at one slot, but none two.
class Declared {
 public:
  void add(int first, int size) {
    for (int i = 0; i < size; ++i) slots_.insert(first + i);
  }
  int end() const { return slots_.empty() ? 0 : *slots_.rbegin() + 1; }
  int count() const { return int(slots_.size()); }

 private:
  std::set<int> slots_;
};

Declared declared(const std::string& text, const Constants& constants, const std::regex& pattern) {
  Declared all;
  for (std::sregex_iterator it(text.begin(), text.end(), pattern), none; it != none; ++it) {
    all.add(constants.value((*it)[1]), (*it)[2].length() > 0 ? constants.value((*it)[2]) : 1);
  }
  return all;
}

struct AllDeclared {
  Declared buffers, uniforms, images, samplers;
};

AllDeclared all_declared(const std::string& text) {
  static const std::regex storage(R"(layout\(std430, binding = ([^,)]+)\)[^;{]*buffer[^}]*\}\s*\w*(?:\[(\w+)\])?;)");
  static const std::regex uniform(R"(layout\(std140, binding = ([^,)]+)\)\s*uniform\b()?)");
  static const std::regex image(R"(layout\([^)]*binding = ([^,)]+)[^)]*\)[^;]*image\w+ \w+(?:\[(\w+)\])?;)");
  static const std::regex sampler(R"(layout\([^)]*binding = ([^,)]+)[^)]*\)[^;]*sampler\w+ \w+(?:\[(\w+)\])?;)");
  const Constants constants(text);
  return {declared(text, constants, storage), declared(text, constants, uniform), declared(text, constants, image),
          declared(text, constants, sampler)};
}

/// What a stage declares, in all of its variants together.
void expect_within_limits(const std::string& name, const AllDeclared& all) {
  const bool compute = name.ends_with(".comp.glsl");
  EXPECT_LE(all.buffers.end(), need_of(GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS));
  EXPECT_LE(all.buffers.count(),
            need_of(compute ? GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS : GL_MAX_FRAGMENT_SHADER_STORAGE_BLOCKS));
  EXPECT_LE(all.uniforms.count(), need_of(GL_MAX_COMPUTE_UNIFORM_BLOCKS));
  EXPECT_LE(all.images.end(), need_of(GL_MAX_IMAGE_UNITS));
  EXPECT_LE(all.images.count(), need_of(GL_MAX_COMPUTE_IMAGE_UNIFORMS));
  EXPECT_LE(all.samplers.end(), need_of(compute ? GL_MAX_COMPUTE_TEXTURE_IMAGE_UNITS : GL_MAX_TEXTURE_IMAGE_UNITS));
}

TEST(Limits, CoverWhatShadersDeclare) {
  int buffers = 0, images = 0, samplers = 0;
  for (const gl::ShaderFile& file : gl::shader_files()) {
    const std::string name(file.name);
    const bool stage = name.ends_with(".comp.glsl") || name.ends_with(".frag.glsl");
    if (!stage || name.starts_with("voxel/single_pass")) continue;  // that one is tried, and left where it does not fit
    SCOPED_TRACE(name);
    const AllDeclared all = all_declared(gl::expand_shader(file.name));
    expect_within_limits(name, all);
    buffers = std::max(buffers, all.buffers.end());
    images = std::max(images, all.images.end());
    samplers = std::max(samplers, all.samplers.end());
  }
  // Nothing is asked for without need, and the patterns find what there is.
  EXPECT_EQ(buffers, need_of(GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS));
  EXPECT_EQ(images, need_of(GL_MAX_IMAGE_UNITS));
  EXPECT_EQ(samplers, need_of(GL_MAX_TEXTURE_IMAGE_UNITS));
}

TEST(Limits, SeeSlotsByTheirNames) {
  const AllDeclared all = all_declared(
      "#define FIRST_SLOT 12  // of two\n#define NEXT_UNIT (FIRST_SLOT + 2)\n#define N 3\n"
      "layout(std430, binding = FIRST_SLOT) readonly buffer A { uint a[]; };\n"
      "layout(std430, binding = 2 * N) buffer B { uint at[]; } b[N];\n"
      "layout(binding = NEXT_UNIT) uniform sampler2D maps[N];\n"
      "layout(binding = N, rgba32f) uniform restrict image3D picture;\n");
  EXPECT_EQ(all.buffers.end(), 13);
  EXPECT_EQ(all.buffers.count(), 4);
  EXPECT_EQ(all.uniforms.count(), 0);
  EXPECT_EQ(all.images.end(), 4);
  EXPECT_EQ(all.samplers.end(), 17);
}

/// A slot is written in one shared header, from which the program and the shaders have it.
TEST(Slots, HaveNamesThatMeanOneNumber) {
  static const std::regex literal(R"(binding = \d)");
  static const std::regex name(R"(#define (\w+_(?:SLOT|BLOCK|UNIT|IMAGE)) )");
  std::set<std::string> names;
  for (const gl::ShaderFile& file : gl::shader_files()) {
    SCOPED_TRACE(std::string(file.name));
    const std::string text(file.text);
    EXPECT_FALSE(std::regex_search(text, literal));
    if (!file.name.ends_with(".shared.h")) continue;
    for (std::sregex_iterator it(text.begin(), text.end(), name), none; it != none; ++it) {
      EXPECT_TRUE(names.insert((*it)[1]).second) << (*it)[1] << " is defined elsewhere, too";
    }
  }
  EXPECT_GT(names.size(), 80u) << "the pattern must find something";
}

}  // namespace
}  // namespace volgi::test
