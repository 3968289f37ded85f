#include "core/emitter_points.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <numeric>
#include <optional>
#include <utility>

#include "core/halton.h"
#include "core/hilbert.h"
#include "core/luminance.h"
#include "core/sample_sequence.h"
#include "core/surface.h"

namespace volgi {
namespace {

double area_of(const Mesh& mesh, std::uint32_t triangle) {
  const glm::uvec3 t = mesh.triangles[triangle];
  const glm::dvec3 a(mesh.positions[t.x]);
  return 0.5 * glm::length(glm::cross(glm::dvec3(mesh.positions[t.y]) - a, glm::dvec3(mesh.positions[t.z]) - a));
}

/// Texels along the longest edge of the triangle in a texture.
double texels_along(const Scene& scene, const Mesh& mesh, std::uint32_t triangle, const TextureUse& use) {
  const auto& uv = mesh.uv[size_t(use.texcoord)];
  if (use.texture < 0 || uv.empty()) return 0.0;
  const TextureImage& image = scene.images[size_t(scene.textures[size_t(use.texture)].image)];
  const glm::uvec3 t = mesh.triangles[triangle];
  double longest = 0.0;
  for (int k = 0; k < 3; ++k) {
    const glm::vec2 edge = glm::mat2(use.uv_from_texcoord) * (uv[t[(k + 1) % 3]] - uv[t[k]]);
    longest = std::max(longest, double(glm::length(edge * glm::vec2(image.width, image.height))));
  }
  return longest;
}

/// Points on an edge of the lattice that measures a triangle's mean emission; 1 where it is the same everywhere.
int lattice_of(const Scene& scene, const Mesh& mesh, std::uint32_t triangle) {
  const Material& material = scene.materials[size_t(mesh.material)];
  const bool covered = material.alpha_mode == AlphaMode::opaque;
  if (material.emissive.texture < 0 && (covered || (material.base_color.texture < 0 && mesh.colors.empty()))) return 1;
  double texels = texels_along(scene, mesh, triangle, material.emissive);
  if (!covered) texels = std::max(texels, texels_along(scene, mesh, triangle, material.base_color));
  return int(std::clamp(std::ceil(2.0 * texels), 4.0, 128.0));
}

/// Emitted radiance of a textured opaque triangle at its barycentrics: what surface_point() says, and no more.
class EmissionOfTexture {
 public:
  EmissionOfTexture(const Scene& scene, const Mesh& mesh, std::uint32_t triangle)
      : scene_(scene), material_(scene.materials[size_t(mesh.material)]) {
    const auto& uv = mesh.uv[size_t(material_.emissive.texcoord)];
    if (uv.empty()) return;
    const glm::uvec3 t = mesh.triangles[triangle];
    for (int k = 0; k < 3; ++k) corner_[k] = glm::vec2(material_.emissive.uv_from_texcoord * glm::vec3(uv[t[k]], 1.0f));
  }
  glm::dvec3 at(double u, double v) const {
    const glm::vec2 place = float(1.0 - u - v) * corner_[0] + float(u) * corner_[1] + float(v) * corner_[2];
    const glm::vec3 texel(sample_texture(scene_, material_.emissive.texture, place, true));
    return glm::dvec3(material_.emissive_radiance * texel);
  }

 private:
  const Scene& scene_;
  const Material& material_;
  glm::vec2 corner_[3] = {};
};

/// The n^2 equal triangles of a lattice: of the square (i, j) the lower left one, and the upper right one where there
/// is.
struct Part {
  int i, j;
  bool upper;
  glm::dvec2 middle(int n) const {
    const double third = upper ? 2.0 / 3.0 : 1.0 / 3.0;
    return {(i + third) / n, (j + third) / n};
  }
  glm::dvec2 along(int n, glm::dvec2 barycentric) const {
    return (upper ? glm::dvec2(i + 1, j + 1) - barycentric : glm::dvec2(i, j) + barycentric) / double(n);
  }
  /// @param xi  in the unit square, even by area.
  glm::dvec2 at(int n, glm::dvec2 xi) const {
    const double root = std::sqrt(xi.x);
    return along(n, {1.0 - root, root * xi.y});
  }
};

template <typename F>
void for_each_part(int n, const F& f) {
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i + j < n; ++i) {
      f(Part{i, j, false});
      if (i + j + 1 < n) f(Part{i, j, true});
    }
  }
}

/// What a triangle emits: radiance times alpha, its mean and, of a textured one, that of each part of the lattice.
struct Emission {
  glm::dvec3 mean{0.0};
  int lattice = 1;
  std::vector<glm::vec3> of_part;
};

template <typename F>
Emission emission_of(int n, const F& radiance) {
  Emission e;
  e.lattice = n;
  if (n == 1) {
    e.mean = radiance(Part{0, 0, false}.middle(1));
    return e;
  }
  e.of_part.reserve(size_t(n) * size_t(n));
  for_each_part(n, [&](Part part) {
    glm::dvec3 here(0.0);  // the edge of a texel may cross the part
    for_each_part(2, [&](Part quarter) { here += 0.25 * radiance(part.along(n, quarter.middle(2))); });
    e.mean += here;
    e.of_part.emplace_back(here);
  });
  e.mean /= double(n * n);
  return e;
}

Emission emission_of(const Scene& scene, const Mesh& mesh, std::uint32_t triangle) {
  const Material& material = scene.materials[size_t(mesh.material)];
  const int n = lattice_of(scene, mesh, triangle);
  if (material.emissive.texture >= 0 && material.alpha_mode == AlphaMode::opaque && !material.unlit) {
    const EmissionOfTexture emission(scene, mesh, triangle);
    return emission_of(n, [&](glm::dvec2 b) { return emission.at(b.x, b.y); });
  }
  return emission_of(n, [&](glm::dvec2 b) {
    const SurfacePoint p = surface_point(scene, mesh, triangle, float(b.x), float(b.y));
    return glm::dvec3(p.emission) * double(p.alpha);
  });
}

std::vector<Emission> emissions_of(const Scene& scene, const Mesh& mesh) {
  std::vector<Emission> all(mesh.triangles.size());
  tbb::parallel_for(tbb::blocked_range<size_t>(0, all.size(), 64), [&](const tbb::blocked_range<size_t>& range) {
    for (size_t t = range.begin(); t < range.end(); ++t) all[t] = emission_of(scene, mesh, std::uint32_t(t));
  });
  return all;
}

std::uint32_t packed(Part part) {
  return std::uint32_t(2 * part.i + (part.upper ? 1 : 0)) | std::uint32_t(part.j) << 16;
}
Part unpacked(std::uint32_t place) { return {int((place & 0xffffu) / 2), int(place >> 16), (place & 1u) != 0}; }

std::vector<EmitterPoint> in_order_of(const std::vector<std::uint64_t>& places,
                                      const std::vector<EmitterPoint>& points) {
  std::vector<size_t> order(points.size());
  std::iota(order.begin(), order.end(), size_t(0));
  std::sort(order.begin(), order.end(),
            [&](size_t a, size_t b) { return std::pair(places[a], a) < std::pair(places[b], b); });
  std::vector<EmitterPoint> ordered;
  ordered.reserve(points.size());
  for (const size_t i : order) ordered.push_back(points[i]);
  return ordered;
}

}  // namespace

EmitterPoints::EmitterPoints(const Scene& scene) : scene_(&scene) {
  double total = 0.0;
  for (std::uint32_t m = 0; m < scene.meshes.size(); ++m) {
    const Mesh& mesh = scene.meshes[m];
    const Material& material = scene.materials[size_t(mesh.material)];
    if (!material.is_emissive()) continue;
    const std::vector<Emission> emissions = emissions_of(scene, mesh);
    // Bright spots that the lattice missed still get a point now and then.
    const double least = 1e-3 * luminance(material.emissive_radiance);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const Emission& e = emissions[t];
      const double area = area_of(mesh, t);
      Side side{m, t, false, area, e.lattice, std::uint32_t(pieces_.size())};
      if (e.lattice > 1) add_pieces(e.lattice, e.of_part, least);
      const double mean = std::max(luminance(e.mean), least);
      if (!(mean * area > 0.0)) continue;
      for (int k = 0; k < (material.double_sided ? 2 : 1); ++k) {
        side.back = k == 1;
        flux_ += glm::pi<double>() * area * e.mean;
        total += mean * area;
        sides_.push_back(side);
        cumulative_.push_back(total);
      }
    }
  }
  for (double& c : cumulative_) c /= total;
}

/// Along Hilbert's curve. A part of the points goes by area alone, so that no dim part is without; the others by the
/// mean of the bands: by luminance blue parts would have few points, and each of them much blue light.
void EmitterPoints::add_pieces(int lattice, const std::vector<glm::vec3>& emission, double least) {
  constexpr double BY_AREA = 0.1;
  struct Entry {
    std::uint32_t on_curve, place;
    glm::vec3 emission;
  };
  const auto brightness = [](glm::vec3 e) { return double(e.x + e.y + e.z) / 3.0; };
  double mean = 0.0;
  for (const glm::vec3& e : emission) mean += brightness(e) / double(emission.size());
  const double floor = std::max(BY_AREA * mean, least);
  std::vector<Entry> entries;
  entries.reserve(emission.size());
  for_each_part(lattice, [&](Part part) {
    const glm::vec2 middle(part.middle(lattice));
    entries.push_back({hilbert_index(middle), packed(part), emission[entries.size()]});
  });
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return std::pair(a.on_curve, a.place) < std::pair(b.on_curve, b.place);
  });
  double sum = 0.0;
  for (const Entry& e : entries) pieces_.push_back({e.place, e.emission, sum += brightness(e.emission) + floor});
  for (size_t k = pieces_.size() - entries.size(); k < pieces_.size(); ++k) pieces_[k].cumulative /= sum;
}

EmitterPoint EmitterPoints::point_at(const Side& side, glm::dvec2 at, double area_m2) const {
  const Mesh& mesh = scene_->meshes[side.mesh];
  const SurfacePoint p = surface_point(*scene_, mesh, side.triangle, float(at.x), float(at.y));
  const glm::vec3 radiance = p.emission * p.alpha;
  return {p.position, side.back ? -p.geometric_normal : p.geometric_normal,
          glm::vec3(glm::dvec3(radiance) * (glm::pi<double>() * area_m2)), float(area_m2)};
}

/// On a textured side: where in its power, 0 ... 1, `along` is. @param area_m2  that an even point would stand for.
EmitterPoint EmitterPoints::point_along(const Side& side, double along, glm::dvec2 xi, double area_m2) const {
  const auto first = pieces_.begin() + side.first_piece, end = first + std::ptrdiff_t(side.lattice) * side.lattice;
  auto piece = std::upper_bound(first, end, along, [](double a, const Piece& p) { return a < p.cumulative; });
  if (piece == end) --piece;
  const double share = piece->cumulative - (piece == first ? 0.0 : std::prev(piece)->cumulative);
  const double own_m2 = area_m2 / (share * double(end - first));
  EmitterPoint point = point_at(side, unpacked(piece->place).at(side.lattice, xi), own_m2);
  point.flux = glm::vec3(glm::dvec3(piece->emission) * (glm::pi<double>() * own_m2));  // of all of it
  return point;
}

/// The side that makes a parallelogram of this one's triangle, as the two triangles of a rectangle do, and where points
/// of it lie.
std::optional<EmitterPoints::Parallelogram> EmitterPoints::parallelogram_of(size_t k) const {
  const Side& s = sides_[k];
  const size_t other = k + (scene_->materials[size_t(scene_->meshes[s.mesh].material)].double_sided ? 2 : 1);
  if (other >= sides_.size() || sides_[other].mesh != s.mesh || sides_[other].triangle != s.triangle + 1)
    return std::nullopt;
  const Mesh& mesh = scene_->meshes[s.mesh];
  const glm::uvec3 a = mesh.triangles[s.triangle], b = mesh.triangles[sides_[other].triangle];
  const auto corner = [&](glm::uvec3 t, int i) { return glm::dvec3(mesh.positions[t[(i + 3) % 3]]); };
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const glm::dvec3 o = corner(a, i), p = corner(a, i + 1), q = corner(a, i + 2), far = p + q - o;
      const double near = 1e-4 * (glm::distance(p, o) + glm::distance(q, o));
      if (glm::distance(corner(b, j), far) < near && glm::distance(corner(b, j + 1), q) < near &&
          glm::distance(corner(b, j + 2), p) < near)
        return Parallelogram{other, i, j};
    }
  }
  return std::nullopt;
}

/// @param at  of the parallelogram's square.
EmitterPoint EmitterPoints::point_of(size_t k, const Parallelogram& whole, glm::dvec2 at, double area_m2) const {
  const bool beyond = at.x + at.y > 1.0;
  // From the far corner on, the second triangle's next corner is the first one's last.
  const glm::dvec2 own = beyond ? glm::dvec2(1.0 - at.x, 1.0 - at.y) : at;
  const int first = beyond ? whole.far_corner : whole.corner;
  glm::dvec3 weights(0.0);
  weights[first] = 1.0 - own.x - own.y;
  weights[(first + 1) % 3] = own.x;
  weights[(first + 2) % 3] = own.y;
  return point_at(sides_[beyond ? whole.other : k], {weights.y, weights.z}, area_m2);
}

namespace {

constexpr int CELL_SAMPLES = 4;  // on an edge, of what a cell of the grid sends

/// @param point  at a place of the cell's unit square.
template <typename F>
EmitterPoint mean_of_cell(EmitterPoint middle, const F& point) {
  glm::dvec3 sum(0.0);
  for (int j = 0; j < CELL_SAMPLES; ++j) {
    for (int i = 0; i < CELL_SAMPLES; ++i)
      sum += glm::dvec3(point((glm::dvec2(i, j) + 0.5) / double(CELL_SAMPLES)).flux);
  }
  middle.flux = glm::vec3(sum / double(CELL_SAMPLES * CELL_SAMPLES));
  return middle;
}

}  // namespace

std::vector<EmitterPoint> EmitterPoints::grid_points(int count) const {
  double area = 0.0;
  for (const Side& s : sides_) area += s.area_m2;
  std::vector<EmitterPoint> points;
  std::vector<bool> done(sides_.size(), false);
  for (size_t k = 0; k < sides_.size(); ++k) {
    if (done[k]) continue;
    const Side& s = sides_[k];
    const std::optional<Parallelogram> whole = parallelogram_of(k);
    const double own = s.area_m2 * (whole ? 2.0 : 1.0);
    const int n = std::max(int(std::sqrt(count * own / area) + 1e-6), 1);
    const double cell = own / double(n * n);
    if (!whole) {
      for_each_part(n, [&](Part part) {
        points.push_back(mean_of_cell(point_at(s, part.middle(n), cell),
                                      [&](glm::dvec2 xi) { return point_at(s, part.at(n, xi), cell); }));
      });
      continue;
    }
    done[whole->other] = true;
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const auto at = [&](glm::dvec2 xi) { return point_of(k, *whole, (glm::dvec2(i, j) + xi) / double(n), cell); };
        points.push_back(mean_of_cell(at(glm::dvec2(0.5)), at));
      }
    }
  }
  return points;
}

std::vector<EmitterPanel> EmitterPoints::panels(int texels, size_t most) const {
  std::vector<EmitterPanel> list;
  std::vector<bool> done(sides_.size(), false);
  constexpr double OF_RADIANCE = 1.0 / glm::pi<double>();  // area whose flux is its radiance [m^2]
  for (size_t k = 0; k < sides_.size(); ++k) {
    if (done[k]) continue;
    const std::optional<Parallelogram> whole = parallelogram_of(k);
    if (!whole || list.size() == most) return {};
    done[whole->other] = true;
    const EmitterPoint corner = point_of(k, *whole, {0.0, 0.0}, OF_RADIANCE);
    EmitterPanel panel{corner.position,
                       point_of(k, *whole, {1.0, 0.0}, OF_RADIANCE).position - corner.position,
                       point_of(k, *whole, {0.0, 1.0}, OF_RADIANCE).position - corner.position,
                       corner.normal,
                       {}};
    panel.radiance.reserve(size_t(texels) * size_t(texels));
    for (int j = 0; j < texels; ++j) {
      for (int i = 0; i < texels; ++i)
        panel.radiance.push_back(point_of(k, *whole, (glm::dvec2(i, j) + 0.5) / double(texels), OF_RADIANCE).flux);
    }
    list.push_back(std::move(panel));
  }
  return list;
}

std::vector<EmitterPoint> EmitterPoints::points(int count, int sample) const {
  std::vector<EmitterPoint> points;
  if (empty()) return points;
  points.reserve(size_t(count));
  std::vector<std::uint64_t> places;  // side, then place on the curve
  places.reserve(size_t(count));
  const double in_stratum = place_in_strata(std::uint64_t(sample));
  const std::uint64_t first = first_halton_point(std::uint64_t(sample), count);
  size_t side = 0;
  for (int i = 0; i < count; ++i) {
    const double at = (i + in_stratum) / count;
    while (side + 1 < sides_.size() && cumulative_[side] <= at) ++side;
    const Side& s = sides_[side];
    const double before = side > 0 ? cumulative_[side - 1] : 0.0, probability = cumulative_[side] - before;
    const double area = s.area_m2 / (probability * count);
    const glm::dvec2 xi = halton(first + std::uint64_t(i));
    if (s.lattice > 1) {
      points.push_back(point_along(s, (at - before) / probability, xi, area));
      places.push_back(std::uint64_t(side) << 32 | std::uint64_t(i));
    } else {
      const double root = std::sqrt(xi.x);  // even by area
      points.push_back(point_at(s, {1.0 - root, root * xi.y}, area));
      places.push_back(std::uint64_t(side) << 32 | hilbert_index(glm::vec2(xi)));
    }
  }
  return in_order_of(places, points);
}

}  // namespace volgi
