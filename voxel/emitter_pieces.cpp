#include "voxel/emitter_pieces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "core/surface.h"

namespace volgi {

namespace {

// A corner of a clipped triangle: barycentric (u, v) and position in cell units.
struct Corner {
  glm::vec2 uv;
  glm::vec3 cell;
};

// At most 3 + 4 corners: a triangle cut by four half-planes.
struct Polygon {
  std::array<Corner, 8> corners;
  int count = 0;
  void add(const Corner& c) {
    if (count < int(corners.size())) corners[size_t(count++)] = c;
  }
};

/// Keeps the part with sign * (x[axis] - bound) >= 0 (Sutherland-Hodgman).
Polygon clip(const Polygon& in, int axis, float bound, float sign) {
  Polygon out;
  for (int i = 0; i < in.count; ++i) {
    const Corner& a = in.corners[size_t(i)];
    const Corner& b = in.corners[(size_t(i) + 1) % size_t(in.count)];
    float da = sign * (a.cell[axis] - bound);
    float db = sign * (b.cell[axis] - bound);
    if (da >= 0.0f) out.add(a);
    if ((da >= 0.0f) != (db >= 0.0f)) {
      float t = da / (da - db);
      out.add({glm::mix(a.uv, b.uv, t), glm::mix(a.cell, b.cell, t)});
    }
  }
  return out;
}

/// Twice the area in barycentric space: the triangle itself has 1.
float double_uv_area(const Polygon& p) {
  float sum = 0.0f;
  for (int i = 1; i + 1 < p.count; ++i) {
    glm::vec2 a = p.corners[size_t(i)].uv - p.corners[0].uv;
    glm::vec2 b = p.corners[size_t(i) + 1].uv - p.corners[0].uv;
    sum += a.x * b.y - a.y * b.x;
  }
  return std::abs(sum);
}

glm::vec2 uv_centroid(const Polygon& p) {
  glm::vec2 sum(0.0f);
  float weight = 0.0f;
  for (int i = 1; i + 1 < p.count; ++i) {
    glm::vec2 o = p.corners[0].uv;
    glm::vec2 a = p.corners[size_t(i)].uv;
    glm::vec2 b = p.corners[size_t(i) + 1].uv;
    float area = std::abs((a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x));
    sum += area * (o + a + b) / 3.0f;
    weight += area;
  }
  return weight > 0.0f ? sum / weight : p.corners[0].uv;
}

/// Mean emission over the piece: centroid, or half way from it to each of four corners when a texture varies.
glm::vec3 mean_emission(const Scene& scene, const Mesh& mesh, std::uint32_t triangle, const Polygon& p,
                        glm::vec2 centre) {
  const Material& material = scene.materials[size_t(mesh.material)];
  if (material.emissive.texture < 0) return surface_point(scene, mesh, triangle, centre.x, centre.y).emission;
  glm::vec3 sum(0.0f);
  for (int i = 0; i < p.count; ++i) {
    glm::vec2 uv = 0.5f * (centre + p.corners[size_t(i)].uv);
    sum += surface_point(scene, mesh, triangle, uv.x, uv.y).emission;
  }
  return sum / float(p.count);
}

void add_piece(const Scene& scene, const Mesh& mesh, std::uint32_t triangle, const Polygon& piece, float triangle_area,
               std::vector<FluxSample>& out) {
  float area = double_uv_area(piece) * triangle_area;
  if (!(area > 0.0f)) return;
  glm::vec2 centre = uv_centroid(piece);
  SurfacePoint point = surface_point(scene, mesh, triangle, centre.x, centre.y);
  glm::vec3 flux = glm::pi<float>() * point.alpha * area * mean_emission(scene, mesh, triangle, piece, centre);
  if (flux == glm::vec3(0.0f)) return;
  out.push_back({point.position, point.geometric_normal, flux});
  if (scene.materials[size_t(mesh.material)].double_sided)
    out.push_back({point.position, -point.geometric_normal, flux});
}

int nearest_axis(glm::vec3 n) {
  glm::vec3 a = glm::abs(n);
  return a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
}

void cut_triangle(const Scene& scene, const Grid& grid, const Mesh& mesh, std::uint32_t triangle,
                  std::vector<FluxSample>& out) {
  glm::uvec3 t = mesh.triangles[triangle];
  glm::vec3 p[3] = {mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]};
  glm::vec3 cross = glm::cross(p[1] - p[0], p[2] - p[0]);
  float area = 0.5f * glm::length(cross);
  if (!(area > 0.0f)) return;
  Polygon whole;
  const glm::vec2 uv[3] = {{0.0f, 0.0f}, {1.0f, 0.0f}, {0.0f, 1.0f}};
  for (int i = 0; i < 3; ++i) whole.add({uv[i], shared::cell_from_world(grid, p[i])});
  int axis = nearest_axis(cross);
  int b = shared::axis_b(axis);
  int c = shared::axis_c(axis);
  auto range = [&](int a, int& first, int& last) {
    float lo = std::min({whole.corners[0].cell[a], whole.corners[1].cell[a], whole.corners[2].cell[a]});
    float hi = std::max({whole.corners[0].cell[a], whole.corners[1].cell[a], whole.corners[2].cell[a]});
    first = std::clamp(int(std::floor(lo)), 0, grid.cells[a] - 1);
    last = std::clamp(int(std::ceil(hi)) - 1, first, grid.cells[a] - 1);
  };
  int b0, b1, c0, c1;
  range(b, b0, b1);
  range(c, c0, c1);
  for (int j = c0; j <= c1; ++j) {
    // The first and last rows and columns keep what rounding puts outside the grid, so that nothing is lost.
    Polygon row = whole;
    if (j > c0) row = clip(row, c, float(j), 1.0f);
    if (j < c1) row = clip(row, c, float(j + 1), -1.0f);
    for (int i = b0; i <= b1 && row.count > 2; ++i) {
      Polygon piece = row;
      if (i > b0) piece = clip(piece, b, float(i), 1.0f);
      if (i < b1) piece = clip(piece, b, float(i + 1), -1.0f);
      if (piece.count > 2) add_piece(scene, mesh, triangle, piece, area, out);
    }
  }
}

}  // namespace

std::vector<FluxSample> emitter_pieces(const Scene& scene, const Grid& grid) {
  std::vector<FluxSample> out;
  for (const Mesh& mesh : scene.meshes) {
    if (!scene.materials[size_t(mesh.material)].is_emissive()) continue;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) cut_triangle(scene, grid, mesh, t, out);
  }
  return out;
}

}  // namespace volgi
