#include "screen/gather/subsplats/discontinuity_mipmaps.h"

#include "shaders/screen/gather/subsplats/slots.shared.h"
#include "shaders/shared/group_sizes.shared.h"

namespace volgi::screen {

namespace {

using Criterion = DiscontinuityOptions::Criterion;

constexpr const char* SHADER = "screen/gather/subsplats/discontinuity_mipmaps.comp.glsl";
constexpr float kNever = 3.0e38f;

bool is_one_of(Criterion criterion, std::initializer_list<Criterion> some) {
  for (const Criterion c : some) {
    if (c == criterion) return true;
  }
  return false;
}

gl::Texture tower(const SubsplatLevels& levels, GLenum format) {
  return gl::Texture::make_2d(format, levels.tower().x, levels.tower().y);
}

}  // namespace

DiscontinuityMipmaps::DiscontinuityMipmaps(const SubsplatLevels& levels, const DiscontinuityOptions& options)
    : levels_(levels),
      options_(options),
      with_depth_(
          is_one_of(options.criterion, {Criterion::depth_normal, Criterion::depth_curvature, Criterion::depth})),
      with_normals_(
          is_one_of(options.criterion, {Criterion::depth_normal, Criterion::derivative_normal, Criterion::normal})),
      with_derivative_(is_one_of(
          options.criterion, {Criterion::derivative_normal, Criterion::derivative_curvature, Criterion::derivative})),
      with_curvature_(is_one_of(options.criterion,
                                {Criterion::depth_curvature, Criterion::derivative_curvature, Criterion::curvature})),
      depth_ranges_(tower(levels, GL_RG32F)),
      discontinuities_(tower(levels, GL_R8UI)),
      from_pixels_(gl::Program::compute(SHADER, {"FROM_PIXELS"})),
      from_level_(gl::Program::compute(SHADER)) {
  if (with_normals_) {
    least_normals_ = tower(levels, GL_RGBA16_SNORM);
    most_normals_ = tower(levels, GL_RGBA16_SNORM);
  }
  if (with_derivative_ || with_curvature_) bends_ = tower(levels, GL_RG32F);
}

void DiscontinuityMipmaps::set_thresholds(const gl::Program& program, const Camera& camera,
                                          float scene_diagonal_m) const {
  const glm::mat4 camera_space = camera_from_world(camera);
  const glm::vec4 backwards(camera_space[0].z, camera_space[1].z, camera_space[2].z, camera_space[3].z);
  program.set("depth_plane", -backwards);
  program.set("border", options_.borders ? 1 : 0);
  program.set("with_normals", with_normals_ ? 1 : 0);
  program.set("with_derivative", with_derivative_ ? 1 : 0);
  program.set("with_curvature", with_curvature_ ? 1 : 0);
  program.set("depth_threshold_m", with_depth_ ? options_.depth * scene_diagonal_m : kNever);
  program.set("derivative_threshold_m", options_.derivative * scene_diagonal_m / float(levels_.size.y));
  program.set("normal_threshold", options_.normal);
  program.set("curvature_threshold", options_.curvature);
}

void DiscontinuityMipmaps::run(const GBuffer& gbuffer, const Camera& camera, float scene_diagonal_m,
                               gl::PassTimer& timer) {
  const auto scope = timer.scope(name);
  gbuffer.bind();
  depth_ranges_.bind_image(DEPTH_RANGES_IMAGE, GL_READ_WRITE);
  discontinuities_.bind_image(DISCONTINUITIES_IMAGE, GL_READ_WRITE);
  if (with_normals_) {
    least_normals_.bind_image(LEAST_NORMALS_IMAGE, GL_READ_WRITE);
    most_normals_.bind_image(MOST_NORMALS_IMAGE, GL_READ_WRITE);
  }
  if (with_derivative_ || with_curvature_) bends_.bind_image(BENDS_IMAGE, GL_READ_WRITE);
  for (const gl::Program* program : {&from_pixels_, &from_level_}) {
    levels_.set(*program);
    set_thresholds(*program, camera, scene_diagonal_m);
  }
  for (int level = 1; level <= levels_.last; ++level) {
    const gl::Program& program = level == 1 ? from_pixels_ : from_level_;
    const glm::ivec2 size = shared::level_size(levels_.size, level);
    program.set("level", level);
    program.use();
    gl::dispatch({size.x, size.y, 1}, {SQUARE_GROUP, SQUARE_GROUP, 1});
    glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  }
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

void DiscontinuityMipmaps::bind(const gl::Program& program) const {
  levels_.set(program);
  program.set("diagonals", options_.diagonals ? 1 : 0);
  discontinuities_.bind(DISCONTINUITIES_UNIT);
}

size_t DiscontinuityMipmaps::bytes() const {
  const size_t texel_bytes = 8 + 1 + (with_normals_ ? 16 : 0) + (with_derivative_ || with_curvature_ ? 8 : 0);
  return texel_bytes * size_t(levels_.tower().x) * size_t(levels_.tower().y);
}

void DiscontinuityMipmaps::list_textures(std::vector<NamedTexture>& list) const {
  list_texture(list, name, "depth", depth_ranges_);
  list_texture(list, name, "least normals", least_normals_);
  list_texture(list, name, "most normals", most_normals_);
  list_texture(list, name, "derivative and curvature", bends_);
  list_texture(list, name, "discontinuities", discontinuities_);
}

}  // namespace volgi::screen
