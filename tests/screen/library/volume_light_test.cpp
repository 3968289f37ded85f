// The volume's light in a program of somebody else's: raw OpenGL, its own shader, no glTF.
#include "screen/library/volume_light.h"

#include <gtest/gtest.h>
#include <time.h>

#include <algorithm>
#include <memory>

#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "core/gl/scene_buffers.h"
#include "reference/path_tracer.h"
#include "screen/base/gbuffer.h"
#include "screen/base/reflective_shadow_map.h"
#include "screen/bounces/volume/frame_volume.h"
#include "tests/screen/screen_scene.h"
#include "tests/support/gl_test.h"

namespace volgi::test {
namespace {

using VolumeLightTest = GlTest;
constexpr int SIZE = 32;

/// A box of 2 m, fronts inwards, a lamp under its ceiling.
Scene lamp_in_a_box(float intensity) {
  Scene scene;
  const int grey = add_material(scene, glm::vec3(0.5f));
  add_quad(scene, grey, {-1, -1, 1}, {2, 0, 0}, {0, 0, -2});
  add_quad(scene, grey, {-1, 1, -1}, {2, 0, 0}, {0, 0, 2});
  add_quad(scene, grey, {-1, -1, -1}, {2, 0, 0}, {0, 2, 0});
  add_quad(scene, grey, {1, -1, 1}, {-2, 0, 0}, {0, 2, 0});
  add_quad(scene, grey, {-1, -1, 1}, {0, 0, -2}, {0, 2, 0});
  add_quad(scene, grey, {1, -1, -1}, {0, 0, 2}, {0, 2, 0});
  Light lamp;
  lamp.position = {0, 0.8f, 0};
  lamp.intensity = glm::vec3(intensity, 0.5f * intensity, 0.0f);
  scene.lights = {lamp};
  update_bounds(scene);
  return scene;
}

/// A foreign program that draws what a floor reflects of the volume's light.
class Floor {
 public:
  Floor() {
    program_ = glCreateProgram();
    add(GL_VERTEX_SHADER,
        "out vec2 at; void main() { at = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0; "
        "gl_Position = vec4(at, 0, 1); }");
    add(GL_FRAGMENT_SHADER, gl::shader_source("screen/library/volume_light.glsl") +
                                "in vec2 at; out vec4 color; void main() { color = vec4(0.5 / 3.14159265 * "
                                "volgi_irradiance(vec3(at.x, -1, at.y), vec3(0, 1, 0)), 1); }");
    glLinkProgram(program_);
    GLint linked = 0;
    glGetProgramiv(program_, GL_LINK_STATUS, &linked);
    EXPECT_TRUE(linked);
    target_ = gl::Texture::make_2d(GL_RGBA32F, SIZE, SIZE);
    const std::array colors{gl::Framebuffer::Attachment{&target_}};
    framebuffer_ = gl::Framebuffer(colors, {}, glm::ivec2(SIZE));
    glCreateVertexArrays(1, &no_vertices_);
  }
  ~Floor() {
    glDeleteProgram(program_);
    glDeleteVertexArrays(1, &no_vertices_);
  }
  Floor(const Floor&) = delete;
  Floor& operator=(const Floor&) = delete;

  glm::dvec3 mean(const screen::VolumeLight& light) {
    framebuffer_.bind();
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    glUseProgram(program_);
    light.bind(program_, 5);
    glBindVertexArray(no_vertices_);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    const std::vector<float> pixels = target_.download(4);
    glm::dvec3 sum(0.0);
    for (size_t i = 0; i < pixels.size(); i += 4) sum += glm::dvec3(pixels[i], pixels[i + 1], pixels[i + 2]);
    return sum / double(SIZE * SIZE);
  }

 private:
  void add(GLenum kind, const std::string& body) {
    const std::string text = "#version 450 core\n" + body;
    const GLuint shader = glCreateShader(kind);
    const char* all = text.c_str();
    glShaderSource(shader, 1, &all, nullptr);
    glCompileShader(shader);
    glAttachShader(program_, shader);
    glDeleteShader(shader);
  }
  GLuint program_ = 0, no_vertices_ = 0;
  gl::Texture target_;
  gl::Framebuffer framebuffer_;
};

glm::dvec3 traced_floor(const Scene& scene) {
  Camera camera = look_at_camera({0, 0.5f, 0}, {0, -1, 0.001f}, 0.5f, scene.bounds_min, scene.bounds_max);
  camera.kind = Camera::Kind::orthographic;
  camera.ymag = 0.99f;
  PathTracerOptions o;
  o.size = {SIZE, SIZE};
  o.samples_per_pixel = 32;
  o.light = PathTracerOptions::Light::indirect;
  const Image image = path_trace(scene, camera, o).color;
  glm::dvec3 sum(0.0);
  for (const glm::vec3& p : image.pixels) sum += glm::dvec3(p);
  return sum / double(image.pixels.size());
}

// A volume of 16 cells against paths. What `ordinates` keeps in cells are two bands, which hold 3/4 of what a point
// straight overhead brings, and the ceiling above this floor is brightest near the lamp: 0.83 of the light. Over all
// normals together nothing is missing.
TEST_F(VolumeLightTest, LightsAForeignShadersFloor) {
  Scene scene = lamp_in_a_box(10.0f);
  VolumeOptions options;
  options.grid_cells = 16;
  screen::VolumeLight light(scene, options);
  light.update();
  Floor floor;
  const glm::dvec3 got = floor.mean(light), expected = traced_floor(scene);
  RecordProperty("ratio", std::to_string(got.x / expected.x));
  EXPECT_NEAR(got.x / expected.x, 0.83, 0.04);
  EXPECT_NEAR(got.y / got.x, 0.5, 1e-3);
  EXPECT_EQ(got.z, 0.0);

  // Another lamp, in place: as a new one would.
  scene.lights[0].intensity *= 3.0f;
  light.update();
  EXPECT_NEAR(floor.mean(light).x / got.x, 3.0, 1e-2);
}

/// The passes of VolumeLight::update, called one by one as a program would that has no VolumeLight.
class ByHand {
 public:
  ByHand(const Scene& scene, const VolumeOptions& options)
      : scene_(scene),
        buffers_(scene),
        gbuffer_(glm::ivec2(1)),
        camera_(framing_camera(scene.bounds_min, scene.bounds_max)),
        volume_(screen::make_volume_on_gpu(scene, options, glm::ivec2(1))),
        timer_(gl::current_is_software(), false) {}

  void update() {
    buffers_.set_geometry(scene_);
    volume_->follow_scene();
    maps_.run(buffers_, scene_, timer_);
    gbuffer_.run(buffers_, camera_, timer_);
    volume_->run(buffers_, maps_, gbuffer_, camera_, nullptr, timer_);
    volume_->radiance(timer_);
  }

 private:
  const Scene& scene_;
  gl::SceneBuffers buffers_;
  screen::ReflectiveShadowMap maps_;
  screen::GBuffer gbuffer_;
  Camera camera_;
  std::unique_ptr<screen::FrameVolume> volume_;
  gl::PassTimer timer_;
};

/// Of all threads of this process, the software rasterizer's among them [ms]: others on the machine do not count.
template <class Update>
double cpu_ms(const Update& update) {
  const auto now = [] {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return 1e3 * double(time.tv_sec) + 1e-6 * double(time.tv_nsec);
  };
  glFinish();
  const double before = now();
  update();
  glFinish();
  return now() - before;
}

// The least of many, in turn: a neighbour on the same core only adds. What the interface itself does is a check for
// errors.
TEST_F(VolumeLightTest, CostsWhatItsPassesCost) {
  constexpr double LIMIT = 1.02;
  constexpr int FEWEST = 5, MOST = 40;
  const Scene scene = lamp_in_a_box(10.0f);
  VolumeOptions options;
  options.grid_cells = 16;
  screen::VolumeLight light(scene, options);
  ByHand by_hand(scene, options);
  light.update();  // shaders are compiled
  by_hand.update();
  double with = 1e9, without = 1e9;
  for (int k = 0; k < MOST && (k < FEWEST || with > LIMIT * without); ++k) {
    with = std::min(with, cpu_ms([&] { light.update(); }));
    without = std::min(without, cpu_ms([&] { by_hand.update(); }));
  }
  RecordProperty("ratio", std::to_string(with / without));
  EXPECT_LT(with, LIMIT * without) << with << " ms, and " << without << " ms by hand";
}

}  // namespace
}  // namespace volgi::test
