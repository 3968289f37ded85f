#include "core/gl/program.h"

#include <algorithm>
#include <cassert>
#include <functional>
#include <glm/gtc/type_ptr.hpp>
#include <limits>
#include <span>
#include <utility>

#include "core/error.h"
#include "core/gl/limits.h"
#include "core/gl/program_pool_internal.h"
#include "core/gl/shader_source.h"
#include "core/gl/storage.h"
#include "shaders/shared/global_index.shared.h"

namespace volgi::gl {
namespace {

void delete_shader(GLuint id) { glDeleteShader(id); }
void delete_program(GLuint id) { glDeleteProgram(id); }
using Shader = Handle<delete_shader>;

/// On one line.
template <class GetParameter, class GetLog>
std::string info_log(GLuint id, GetParameter get_parameter, GetLog get_log) {
  GLint length = 0;
  get_parameter(id, GL_INFO_LOG_LENGTH, &length);
  std::string log(size_t(std::max(length, 1)), '\0');
  get_log(id, length, nullptr, log.data());
  log.resize(std::min(log.size(), log.find('\0')));
  log.resize(log.find_last_not_of(" \n") + 1);
  std::string line;
  for (const char c : log) line += c == '\n' ? std::string("; ") : std::string(1, c);
  return line;
}

std::string define_lines(const std::vector<std::string>& defines) {
  std::string text = wide_storage() ? "#define WIDE_STORAGE\n" : "";
  for (const std::string& define : defines) text += "#define " + define + '\n';
  return text;
}

Shader compile(GLenum type, const std::string& file, const std::string& source) {
  Shader shader(glCreateShader(type));
  const char* text = source.c_str();
  glShaderSource(shader.id(), 1, &text, nullptr);
  glCompileShader(shader.id());
  GLint compiled = 0;
  glGetShaderiv(shader.id(), GL_COMPILE_STATUS, &compiled);
  if (compiled == 0) {
    throw Error(ExitCode::no_device, "the driver refuses shader " + file + ": " +
                                         info_log(shader.id(), glGetShaderiv, glGetShaderInfoLog) +
                                         " (files: " + file_legend(source) + ")");
  }
  return shader;
}

void link_shaders(GLuint program, std::span<const Shader> shaders, const std::string& name, const char* kept) {
  for (const Shader& shader : shaders) glAttachShader(program, shader.id());
  if (kept != nullptr) glTransformFeedbackVaryings(program, 1, &kept, GL_INTERLEAVED_ATTRIBS);
  glLinkProgram(program);
  for (const Shader& shader : shaders) glDetachShader(program, shader.id());
  GLint linked = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  if (linked == 0) {
    throw Error(ExitCode::no_device,
                "the driver refuses to link " + name + ": " + info_log(program, glGetProgramiv, glGetProgramInfoLog));
  }
  glObjectLabel(GL_PROGRAM, program, -1, name.c_str());
}

}  // namespace

struct Program::Stage {
  GLenum type;
  std::string file;
};

Program Program::link(const std::vector<Stage>& stages, const std::vector<std::string>& defines, const char* kept) {
  const std::string define_text = define_lines(defines);
  std::vector<std::string> sources;
  std::string all;
  for (const Stage& stage : stages) all += sources.emplace_back(expand_shader(stage.file, define_text));
  Program program;
  program.pool_key_ = stages.back().file + '\n' + define_text + std::to_string(std::hash<std::string>()(all));
  ProgramPool* pool = program_pool();
  program.id_ = pool != nullptr ? pool->take(program.pool_key_) : 0;
  if (program.id_ != 0) return program;
  std::vector<Shader> shaders;
  for (size_t k = 0; k < stages.size(); ++k) shaders.push_back(compile(stages[k].type, stages[k].file, sources[k]));
  Handle<delete_program> linked(glCreateProgram());
  count_object();
  link_shaders(linked.id(), shaders, stages.back().file, kept);
  program.id_ = linked.release();
  return program;
}

Program Program::compute(std::string_view file, const std::vector<std::string>& defines) {
  return link({{GL_COMPUTE_SHADER, std::string(file)}}, defines);
}

Program Program::raster(std::string_view base, const std::vector<std::string>& defines) {
  const std::string name(base);
  std::vector<Stage> stages{{GL_VERTEX_SHADER, name + ".vert.glsl"}};
  if (has_shader_file(name + ".geom.glsl")) stages.push_back({GL_GEOMETRY_SHADER, name + ".geom.glsl"});
  stages.push_back({GL_FRAGMENT_SHADER, name + ".frag.glsl"});
  return link(stages, defines);
}

Program Program::raster(std::string_view vertex_file, std::string_view fragment_file,
                        const std::vector<std::string>& defines) {
  return link({{GL_VERTEX_SHADER, std::string(vertex_file)}, {GL_FRAGMENT_SHADER, std::string(fragment_file)}},
              defines);
}

Program Program::feedback(std::string_view base, const char* kept, const std::vector<std::string>& defines) {
  const std::string name(base);
  return link({{GL_VERTEX_SHADER, name + ".vert.glsl"}, {GL_GEOMETRY_SHADER, name + ".geom.glsl"}}, defines, kept);
}

Program::~Program() {
  if (id_ == 0) return;
  if (ProgramPool* pool = program_pool()) pool->give_back(pool_key_, id_);
}

Program::Program(Program&& other) noexcept
    : id_(std::exchange(other.id_, 0)),
      pool_key_(std::move(other.pool_key_)),
      locations_(std::move(other.locations_)) {}

Program& Program::operator=(Program&& other) noexcept {
  std::swap(id_, other.id_);
  std::swap(pool_key_, other.pool_key_);
  std::swap(locations_, other.locations_);
  return *this;
}

void Program::use() const { glUseProgram(id_); }

GLint Program::location(const char* name) const {
  const auto [it, added] = locations_.try_emplace(name, -1);
  if (added) it->second = glGetUniformLocation(id_, name);
  return it->second;
}

void Program::set(const char* name, int v) const { glProgramUniform1i(id_, location(name), v); }
void Program::set(const char* name, GLuint v) const { glProgramUniform1ui(id_, location(name), v); }
void Program::set(const char* name, float v) const { glProgramUniform1f(id_, location(name), v); }
void Program::set(const char* name, glm::vec2 v) const { glProgramUniform2f(id_, location(name), v.x, v.y); }
void Program::set(const char* name, glm::vec3 v) const { glProgramUniform3f(id_, location(name), v.x, v.y, v.z); }
void Program::set(const char* name, glm::vec4 v) const { glProgramUniform4f(id_, location(name), v.x, v.y, v.z, v.w); }
void Program::set(const char* name, glm::ivec2 v) const { glProgramUniform2i(id_, location(name), v.x, v.y); }
void Program::set(const char* name, glm::ivec3 v) const { glProgramUniform3i(id_, location(name), v.x, v.y, v.z); }
void Program::set(const char* name, const glm::mat3& v) const {
  glProgramUniformMatrix3fv(id_, location(name), 1, GL_FALSE, glm::value_ptr(v));
}
void Program::set(const char* name, const glm::mat4& v) const {
  glProgramUniformMatrix4fv(id_, location(name), 1, GL_FALSE, glm::value_ptr(v));
}

void dispatch(glm::ivec3 size, glm::ivec3 local) {
  assert(size.x > 0 && size.y > 0 && size.z > 0);
  const glm::uvec3 groups = glm::uvec3((size + local - 1) / local);
  for (GLuint axis = 0; axis < 3; ++axis) {
    const GLint64 most = limit(GL_MAX_COMPUTE_WORK_GROUP_COUNT, axis);
    if (GLint64(groups[int(axis)]) > most) {
      throw Error(ExitCode::over_limit, "a pass over " + std::to_string(size.x) + " x " + std::to_string(size.y) +
                                            " x " + std::to_string(size.z) + " elements has more than this GPU's " +
                                            std::to_string(most) + " groups; use a smaller grid or picture");
    }
  }
  glDispatchCompute(groups.x, groups.y, groups.z);
}

void dispatch_linear(size_t count, size_t group_size) {
  const size_t most =
      std::numeric_limits<GLint>::max() - GROUPS_PER_ROW * group_size;  // the last row is dispatched whole
  if (count > most) {
    throw Error(ExitCode::over_limit, "a pass over " + std::to_string(count) + " elements exceeds the " +
                                          std::to_string(most) + " that it can count; use a smaller grid or picture");
  }
  const size_t groups = (count + group_size - 1) / group_size;
  const size_t rows = (groups + GROUPS_PER_ROW - 1) / GROUPS_PER_ROW;
  if (rows > 0) glDispatchCompute(GLuint(std::min<size_t>(groups, GROUPS_PER_ROW)), GLuint(rows), 1);
}

void dispatch_indirect(const Buffer& groups) {
  glMemoryBarrier(GL_COMMAND_BARRIER_BIT);
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, groups.id());
  glDispatchComputeIndirect(0);
}

std::string shader_source(std::string_view file) { return expand_shader(file); }

}  // namespace volgi::gl
