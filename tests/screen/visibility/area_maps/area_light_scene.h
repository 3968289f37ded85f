#pragma once
// Area lights placed by hand, their depth maps, and visibility looked up by the shaders that gathers use.
#include <string>

#include "core/gl/shader_source.h"
#include "core/visibility/embree_scene.h"
#include "screen/visibility/area_maps/area_light_shadow.h"
#include "tests/screen/screen_scene.h"
#include "tests/support/gl_test.h"

namespace volgi::test {

inline shared::VirtualAreaLight area_light(glm::vec3 position, glm::vec3 normal, float size_m = 0.3f) {
  const glm::vec3 n = glm::normalize(normal);
  const glm::vec3 across = std::abs(n.x) < 0.9f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
  return {position, size_m * size_m, n, size_m, glm::normalize(glm::cross(across, n)), 1, glm::vec3(1.0f), 0};
}

inline glm::vec3 world_from_area_light(const shared::VirtualAreaLight& light, glm::vec3 d) {
  return d.x * light.right + d.y * glm::cross(light.normal, light.right) + d.z * light.normal;
}

inline glm::vec2 disk_of_texel(int x, int y, int resolution) {
  return (glm::vec2(x, y) + 0.5f) * (2.0f / float(resolution)) - 1.0f;
}

/// Maps of some area lights in a scene.
class AreaLightMaps {
 public:
  AreaLightMaps(const gl::Context& context, const Scene& scene, const std::vector<shared::VirtualAreaLight>& lights,
                int resolution)
      : timer_(context.software(), false),
        buffers_(scene),
        lights_(lights),
        light_buffer_(lights),
        maps_(resolution, int(lights.size())) {
    run();
  }

  void run() { maps_.run(buffers_, light_buffer_, int(lights_.size()), timer_); }

  const screen::ParaboloidDepthMaps& maps() const { return maps_; }
  const std::vector<shared::VirtualAreaLight>& lights() const { return lights_; }
  const gl::Buffer& light_buffer() const { return light_buffer_; }
  gl::PassTimer& timer() { return timer_; }
  std::vector<float> distances() const { return maps_.distance().download(1); }

 private:
  gl::PassTimer timer_;
  gl::SceneBuffers buffers_;
  std::vector<shared::VirtualAreaLight> lights_;
  gl::Buffer light_buffer_;
  screen::ParaboloidDepthMaps maps_;
};

struct Receiver {
  glm::vec4 position;
  glm::vec4 normal;
};

/// area_light_visibility() of light 0 at many points.
class VisibilityLookup {
 public:
  VisibilityLookup(AreaLightMaps& maps, const screen::AreaLightShadow& shadow) : maps_(maps), shadow_(shadow) {
    const std::string source = "#version 450 core\n#define " + shadow.define() + "\n" +
                               gl::expand_shader("screen/visibility/area_maps/area_light_shadow.glsl") +
                               "#line 1 99\n" + kMain;
    const char* text = source.c_str();
    program_ = glCreateShaderProgramv(GL_COMPUTE_SHADER, 1, &text);
    GLint linked = 0;
    glGetProgramiv(program_, GL_LINK_STATUS, &linked);
    if (linked == 0) {
      std::string log(4096, '\0');
      glGetProgramInfoLog(program_, GLsizei(log.size()), nullptr, log.data());
      ADD_FAILURE() << shadow.define() << ": " << log.c_str();
    }
  }
  ~VisibilityLookup() { glDeleteProgram(program_); }
  VisibilityLookup(const VisibilityLookup&) = delete;
  VisibilityLookup& operator=(const VisibilityLookup&) = delete;

  /// Looks up; the answer stays in out().
  void dispatch(const gl::Buffer& receivers, size_t count, const gl::Buffer& out) const {
    glUseProgram(program_);
    glUniform1i(glGetUniformLocation(program_, "count"), GLint(count));
    receivers.bind_storage(0);
    out.bind_storage(1);
    maps_.light_buffer().bind_storage(2);
    shadow_.bind(maps_.maps(), gl::Program());
    gl::dispatch({int(count), 1, 1}, {64, 1, 1});
  }

  std::vector<float> at(const std::vector<Receiver>& receivers) const {
    const gl::Buffer in(receivers);
    const gl::Buffer out(receivers.size() * sizeof(float));
    dispatch(in, receivers.size(), out);
    return out.download<float>(receivers.size());
  }

 private:
  static constexpr const char* kMain = R"(
layout(local_size_x = 64) in;
struct Receiver { vec4 position; vec4 normal; };
layout(std430, binding = 0) readonly buffer Receivers { Receiver receivers[]; };
layout(std430, binding = 1) writeonly buffer Visibility { float visibility[]; };
layout(std430, binding = 2) readonly buffer Lights { VirtualAreaLight lights[]; };
uniform int count;
void main() {
  int i = int(gl_GlobalInvocationID.x);
  if (i >= count) return;
  int k = int(receivers[i].position.w);
  visibility[i] = area_light_visibility(k, lights[k], receivers[i].position.xyz, receivers[i].normal.xyz);
}
)";
  AreaLightMaps& maps_;
  const screen::AreaLightShadow& shadow_;
  GLuint program_ = 0;
};

}  // namespace volgi::test
