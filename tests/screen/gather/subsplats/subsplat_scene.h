#pragma once
// G-buffers of known depth and normals, what the discontinuity mipmaps of one must hold, and which subsplats follow, in
// double precision from the definitions.
#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <vector>

#include "screen/gather/subsplats/discontinuity_mipmaps.h"
#include "screen/gather/subsplats/flattened_buffer.h"
#include "shaders/screen/gather/subsplats/discontinuity.shared.h"
#include "tests/screen/gathered.h"

namespace volgi::test {

using screen::DiscontinuityMipmaps;
using screen::DiscontinuityOptions;
using screen::FlattenedBuffer;
using screen::SubsplatLevels;
using shared::Subsplat;

/// A camera that looks down -z from the origin.
inline Camera straight_camera() {
  Camera camera;
  camera.world_from_camera = glm::mat4(1.0f);
  return camera;
}

/// Pixels whose depth and normal are given, of albedo 1; x and y of the position are the pixel's.
struct PaintedPixels {
  using Depth = std::function<float(int x, int y)>;  // <= 0: background
  PaintedPixels(const gl::Context& context, glm::ivec2 picture_size, const Depth& depth)
      : size(picture_size), gbuffer(size), timer(context.software(), false) {
    std::vector<glm::vec4> positions, normals(size_t(size.x) * size_t(size.y), glm::vec4(0.0f)),
        albedo(normals.size(), glm::vec4(1.0f));
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        const float z = depth(x, y);
        positions.push_back(z > 0.0f ? glm::vec4(float(x), float(y), -z, 1.0f) : glm::vec4(0.0f));
      }
    }
    const auto put = [&](const gl::Texture& texture, const std::vector<glm::vec4>& texels) {
      glTextureSubImage2D(texture.id(), 0, 0, 0, size.x, size.y, GL_RGBA, GL_FLOAT, texels.data());
    };
    put(gbuffer.position(), positions);
    put(gbuffer.normals(), normals);
    put(gbuffer.albedo(), albedo);
  }
  glm::ivec2 size;
  screen::GBuffer gbuffer;
  gl::PassTimer timer;
};

/// What is known of one square of a picture.
struct Square {
  double nearest = double(FAR_AWAY), farthest = 0.0;
  glm::dvec3 least{1.0}, most{-1.0};
  double derivative = 0.0, curvature = 0.0;
  bool has_surface = false, discontinuous = false;
};

/// Criteria in double precision, at every pixel of a square and (borders) around it.
class SquareOracle {
 public:
  SquareOracle(const Seen& seen, const DiscontinuityOptions& options, float scene_diagonal_m)
      : seen_(seen), options_(options), diagonal_m_(double(scene_diagonal_m)) {
    const glm::dmat4 camera = glm::inverse(glm::dmat4(seen.camera.world_from_camera));
    for (const glm::vec4& p : seen.position)
      depth_.push_back(p.w == 0.0f ? double(FAR_AWAY) : -(camera * glm::dvec4(p)).z);
  }

  Square square(Subsplat s) const {
    const int edge = 1 << s.level, around = options_.borders ? edge - 1 : 0;
    const glm::ivec2 first = s.texel * edge;
    Square q;
    for (int y = std::max(first.y - around, 0); y < std::min(first.y + edge + around, seen_.size.y); ++y) {
      for (int x = std::max(first.x - around, 0); x < std::min(first.x + edge + around, seen_.size.x); ++x) {
        const bool inside = x >= first.x && y >= first.y && x < first.x + edge && y < first.y + edge;
        add(x, y, inside, q);
      }
    }
    q.discontinuous = discontinuous(q);
    return q;
  }

 private:
  using Criterion = DiscontinuityOptions::Criterion;
  bool has(std::initializer_list<Criterion> some) const {
    return std::find(some.begin(), some.end(), options_.criterion) != some.end();
  }
  size_t index(int x, int y) const { return size_t(y) * size_t(seen_.size.x) + size_t(x); }

  void add(int x, int y, bool inside, Square& q) const {
    const size_t i = index(x, y);
    q.nearest = std::min(q.nearest, depth_[i]);
    q.farthest = std::max(q.farthest, depth_[i]);
    if (depth_[i] == double(FAR_AWAY)) return;
    q.has_surface = q.has_surface || inside;
    q.least = glm::min(q.least, seen_.normal(i));
    q.most = glm::max(q.most, seen_.normal(i));
    glm::dvec2 slope(0.0);
    for (int axis = 0; axis < 2; ++axis) {
      const int nx = x + 1 - axis, ny = y + axis;
      if (nx >= seen_.size.x || ny >= seen_.size.y) continue;
      const size_t next = index(nx, ny);
      if (depth_[next] == double(FAR_AWAY)) continue;
      slope[axis] = depth_[next] - depth_[i];
      const double cosine = std::clamp(glm::dot(seen_.normal(i), seen_.normal(next)), -1.0, 1.0);
      q.curvature = std::max(q.curvature, 2.0 * std::sin(0.5 * std::acos(cosine)));  // eq. 3.1 as printed
    }
    q.derivative = std::max(q.derivative, glm::length(slope));
  }
  bool discontinuous(const Square& q) const {
    if (q.nearest == double(FAR_AWAY)) return false;
    if (q.farthest == double(FAR_AWAY)) return true;
    const glm::dvec3 turn = q.most - q.least;
    using C = Criterion;
    return (has({C::depth_normal, C::depth_curvature, C::depth}) &&
            q.farthest - q.nearest > double(options_.depth) * diagonal_m_) ||
           (has({C::depth_normal, C::derivative_normal, C::normal}) &&
            std::max({turn.x, turn.y, turn.z}) > double(options_.normal)) ||
           (has({C::derivative_normal, C::derivative_curvature, C::derivative}) &&
            q.derivative > double(options_.derivative) * diagonal_m_ / seen_.size.y) ||
           (has({C::depth_curvature, C::derivative_curvature, C::curvature}) &&
            q.curvature > double(options_.curvature));
  }

  const Seen& seen_;
  DiscontinuityOptions options_;
  double diagonal_m_;
  std::vector<double> depth_;
};

/// Refinement level by level from the coarsest squares, as Nichols 2010, §3.2.3 tells it.
inline std::set<glm::uint> refined_set(const SquareOracle& oracle, const SubsplatLevels& levels, bool diagonals) {
  std::set<glm::uint> done;
  const std::function<void(Subsplat)> refine = [&](Subsplat s) {
    const glm::ivec2 end = shared::level_size(levels.size, s.level);
    const auto there = [&](glm::ivec2 t) { return t.x >= 0 && t.y >= 0 && t.x < end.x && t.y < end.y; };
    if (!there(s.texel) || !oracle.square(s).has_surface) return;
    bool divided = oracle.square(s).discontinuous;
    for (int k = 0; k < 4 && diagonals; ++k) {
      const glm::ivec2 beside = s.texel + 2 * glm::ivec2(k & 1, k >> 1) - 1;
      if (there(beside)) divided = divided || oracle.square({s.level, beside}).discontinuous;
    }
    if (!divided || s.level <= levels.finest) {
      done.insert(shared::pack_subsplat(s));
      return;
    }
    for (int k = 0; k < 4; ++k) refine({s.level - 1, 2 * s.texel + glm::ivec2(k & 1, k >> 1)});
  };
  const glm::ivec2 coarsest = shared::level_size(levels.size, levels.last);
  for (int y = 0; y < coarsest.y; ++y) {
    for (int x = 0; x < coarsest.x; ++x) refine({levels.last, {x, y}});
  }
  return done;
}

/// Fragments of a flattened buffer: where it has light.
inline std::set<glm::uint> lit_set(const FlattenedBuffer& buffer) {
  const SubsplatLevels& levels = buffer.levels();
  const std::vector<glm::vec4> got = texels(buffer.irradiance());
  std::set<glm::uint> lit;
  for (size_t i = 0; i < got.size(); ++i) {
    if (!(got[i].w > 0.0f)) continue;
    const int width = levels.flattened().x;
    const Subsplat s = shared::subsplat_at(levels.size, levels.last, {int(i) % width, int(i) / width});
    lit.insert(shared::pack_subsplat(s));
  }
  return lit;
}

}  // namespace volgi::test
