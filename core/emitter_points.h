#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "core/scene.h"

namespace volgi {

/// A piece of emissive surface, seen as a point.
struct EmitterPoint {
  glm::vec3 position;  // centred frame
  glm::vec3 normal;    // unit, geometric, on the side that the light leaves
  glm::vec3 flux;      // power leaving [W]
  float area_m2;       // of the surface that the point stands for; each side of a double-sided triangle counts
};

/// One side of an emissive parallelogram, and the picture on it.
struct EmitterPanel {
  glm::vec3 corner, along_u, along_v;  // centred frame; edges from the corner [m]
  glm::vec3 normal;                    // unit, on the side that the light leaves
  std::vector<glm::vec3> radiance;     // of texels^2 cells, rows along u [W m^-2 sr^-1]
};

/// Points on a scene's emissive triangles, as many to each, and to each part of a textured one, as its power asks for;
/// or as its area does, on a grid.
class EmitterPoints {
 public:
  /// Cost: sixteen looks at every texel of emissive textures on triangles, at most 128 x 128 a triangle. Memory: 24
  /// bytes for each of them.
  /// @param scene  must outlive this, and its meshes, materials and textures must stay.
  explicit EmitterPoints(const Scene& scene);

  bool empty() const { return sides_.empty(); }
  /// Power leaving all emissive surfaces [W]: pi times the integral of emitted radiance, times alpha.
  glm::dvec3 flux() const { return flux_; }
  /// `count` points, the same ones every time for a `sample` of core/sample_sequence.h: strata of equal power, in the
  /// order of Hilbert's curve on each triangle, so that points that follow on each other are a piece of surface.
  /// Without textures they are Halton points, and the luminance of their flux sums to that of flux() exactly. On
  /// textures strata are cut from the curve through pieces of half a texel, so that bright texels have the points, dark
  /// ones few and large, and the sum is as good as pieces are small.
  std::vector<EmitterPoint> points(int count, int sample = 0) const;
  /// As Nichols 2010 (§5.3.2) has them, whatever shines where: an even grid on each emissive mesh, whose cells are of
  /// one size; two triangles that make a parallelogram have rows and columns. A point sends what its cell sends.
  /// @param count  of all meshes together, at most, but for one on each triangle: every triangle or parallelogram has a
  /// square number of its own.
  std::vector<EmitterPoint> grid_points(int count) const;
  /// All emissive surfaces as pictures, `texels` on each edge; none where one is no parallelogram, or they are more
  /// than `most`. Cost: a look at each cell's middle.
  std::vector<EmitterPanel> panels(int texels, size_t most) const;

 private:
  /// A part of a textured side: one of lattice^2 equal triangles.
  struct Piece {
    std::uint32_t place;  // lower left corner's column and row, 2 i + 1 where it is the upper triangle of its square
    glm::vec3 emission;   // radiance times alpha
    double cumulative;    // share of the side's power of pieces up to this one, the last is 1
  };
  struct Side {
    std::uint32_t mesh, triangle;
    bool back;
    double area_m2;
    int lattice = 1;  // of pieces on an edge; 1: none
    std::uint32_t first_piece = 0;
  };
  void add_pieces(int lattice, const std::vector<glm::vec3>& emission, double least);
  struct Parallelogram {
    size_t other;            // side
    int corner, far_corner;  // across from the common edge, of each triangle
  };
  std::optional<Parallelogram> parallelogram_of(size_t side) const;
  EmitterPoint point_of(size_t side, const Parallelogram& whole, glm::dvec2 at, double area_m2) const;
  EmitterPoint point_at(const Side& side, glm::dvec2 barycentric, double area_m2) const;
  EmitterPoint point_along(const Side& side, double along, glm::dvec2 xi, double area_m2) const;
  const Scene* scene_;
  std::vector<Side> sides_;
  std::vector<Piece> pieces_;
  std::vector<double> cumulative_;  // share of the power of sides [0, i], the last is 1
  glm::dvec3 flux_{0.0};
};

}  // namespace volgi
