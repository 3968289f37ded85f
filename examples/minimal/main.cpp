// An OpenGL program that has its own triangles and shader, and gets bounced light from volgi: create, give it triangles
// and lights, update, bind, sample. Prints the mean radiance of the box's floor.
#include <core/gl/context.h>
#include <epoxy/gl.h>
#include <screen/library/volume_light.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

// Six walls of one albedo, fronts inwards, and a lamp.
static volgi::Scene box(float albedo) {
  volgi::Scene scene;
  scene.materials.resize(1);
  scene.materials[0].base_color_factor = glm::vec4(glm::vec3(albedo), 1.0f);
  scene.materials[0].metallic_factor = 0.0f;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0f, 1.0f}) {
      glm::vec3 middle(0.0f), u(0.0f), v(0.0f);
      middle[axis] = side, u[(axis + 1) % 3] = 1.0f, v[(axis + 2) % 3] = -side;
      volgi::Mesh wall;
      wall.positions = {middle - u - v, middle + u - v, middle + u + v, middle - u + v};
      wall.normals.assign(4, -middle);
      wall.triangles = {{0, 1, 2}, {0, 2, 3}};
      scene.meshes.push_back(wall);
    }
  }
  scene.lights.resize(1);
  scene.lights[0].position = {0.0f, 0.8f, 0.0f};
  scene.lights[0].intensity = glm::vec3(10.0f);
  volgi::update_bounds(scene);
  return scene;
}

static GLuint shader(GLuint program, GLenum kind, const std::string& text) {
  const GLuint name = glCreateShader(kind);
  const char* all = text.c_str();
  glShaderSource(name, 1, &all, nullptr);
  glCompileShader(name);
  glAttachShader(program, name);
  return name;
}

int main() {
  const volgi::gl::Context context;  // with a window of your own: context{volgi::gl::OfWindow()}
  const volgi::Scene scene = box(0.5f);
  volgi::VolumeOptions options;
  options.grid_cells = 16;
  volgi::screen::VolumeLight light(scene, options);
  light.update();  // again whenever lights or triangles have moved

  std::ifstream file(VOLUME_LIGHT_GLSL);
  const std::string include{std::istreambuf_iterator<char>(file), {}};
  const GLuint program = glCreateProgram();
  shader(program, GL_VERTEX_SHADER,
         "#version 450 core\nout vec2 at; void main() { at = vec2(gl_VertexID & 1, "
         "gl_VertexID >> 1) * 4.0 - 1.0; gl_Position = vec4(at, 0, 1); }");
  shader(program, GL_FRAGMENT_SHADER,
         "#version 450 core\n" + include +
             "in vec2 at; out vec4 color; void main() {"
             " color = vec4(0.5 / 3.14159265 * volgi_irradiance(vec3(at.x, -1, at.y), vec3(0, 1, 0)), 1); }");
  glLinkProgram(program);
  GLuint target = 0, frame = 0, no_vertices = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &target);
  glTextureStorage2D(target, 1, GL_RGBA32F, 64, 64);
  glCreateFramebuffers(1, &frame);
  glNamedFramebufferTexture(frame, GL_COLOR_ATTACHMENT0, target, 0);
  glCreateVertexArrays(1, &no_vertices);

  glBindFramebuffer(GL_FRAMEBUFFER, frame), glViewport(0, 0, 64, 64), glDisable(GL_DEPTH_TEST), glDisable(GL_BLEND);
  glBindVertexArray(no_vertices), glUseProgram(program);
  light.bind(program, 0);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  float pixels[64 * 64 * 4], sum = 0.0f;
  glGetTextureImage(target, 0, GL_RGBA, GL_FLOAT, sizeof pixels, pixels);
  for (int i = 0; i < 64 * 64; ++i) sum += pixels[4 * i];
  std::printf("mean radiance of the floor: %.4f W/m2/sr\n", sum / (64 * 64));
}
