#include "screen/library/volume_light.h"

#include <array>
#include <cassert>

#include "core/gl/context.h"
#include "core/gl/scene_buffers.h"
#include "screen/base/gbuffer.h"
#include "screen/base/reflective_shadow_map.h"
#include "screen/bounces/volume/frame_volume.h"

namespace volgi::screen {
namespace {

constexpr glm::ivec2 NO_PICTURE(1);  // the volume is read elsewhere

}  // namespace

struct VolumeLight::Data {
  const Scene& scene;
  VolumeOptions options;
  gl::SceneBuffers buffers;
  ReflectiveShadowMap maps;
  GBuffer gbuffer;
  Camera camera;
  std::unique_ptr<FrameVolume> volume;
  gl::PassTimer timer;
  const RadianceVolumeGl* radiance = nullptr;
  GLuint sampler = 0;

  Data(const Scene& of_scene, const VolumeOptions& asked)
      : scene(of_scene),
        options(asked),
        buffers(of_scene),
        gbuffer(NO_PICTURE),
        camera(framing_camera(of_scene.bounds_min, of_scene.bounds_max)),
        volume(make_volume_on_gpu(of_scene, asked, NO_PICTURE)),
        timer(gl::current_is_software(), false) {
    glCreateSamplers(1, &sampler);
    for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
      glSamplerParameteri(sampler, filter, GL_LINEAR);
  }
  ~Data() { glDeleteSamplers(1, &sampler); }
  Data(const Data&) = delete;
  Data& operator=(const Data&) = delete;
};

VolumeLight::VolumeLight(const Scene& scene, const VolumeOptions& options)
    : data_(std::make_unique<Data>(scene, options)) {}

VolumeLight::~VolumeLight() = default;

void VolumeLight::update() {
  Data& d = *data_;
  d.buffers.set_geometry(d.scene);
  if (!d.volume->follow_scene()) d.volume = make_volume_on_gpu(d.scene, d.options, NO_PICTURE);
  d.maps.run(d.buffers, d.scene, d.timer);
  d.gbuffer.run(d.buffers, d.camera, d.timer);
  d.volume->run(d.buffers, d.maps, d.gbuffer, d.camera, nullptr, d.timer);
  d.radiance = d.volume->radiance(d.timer);
  gl::throw_on_error();
}

void VolumeLight::bind(unsigned program, unsigned unit) const {
  assert(data_->radiance != nullptr && "update() comes first");
  const RadianceVolumeGl& r = *data_->radiance;
  r.sh.bind(unit);
  glBindSampler(unit, data_->sampler);
  const auto at = [&](const char* name) { return glGetUniformLocation(program, name); };
  glProgramUniform1i(program, at("volgi_sh"), GLint(unit));
  glProgramUniform3f(program, at("volgi_cells"), float(r.grid.cells.x), float(r.grid.cells.y), float(r.grid.cells.z));
  const glm::dvec3 origin = glm::dvec3(r.grid.origin) + data_->scene.world_origin;
  glProgramUniform3f(program, at("volgi_origin"), float(origin.x), float(origin.y), float(origin.z));
  glProgramUniform1f(program, at("volgi_cell_size"), r.grid.cell_size_m);
  glProgramUniform1i(program, at("volgi_bands"), r.coefficients == 4 ? 2 : 3);
}

}  // namespace volgi::screen
