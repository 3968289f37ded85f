// Irradiance of a pixel from the sides of the cells in front of its surface: trilinear over those of the eight cells around
// a point half a cell in front of it that see the pixel (seeing_cells), sides with like normals only, and only of cells that
// lie on the pixel's side of their own surfaces, so that neither the surface nor the room behind it lights it.
// docs/theory.md#reconstruction.
#ifndef VOLGI_VOLUME_GATHER_GLSL
#define VOLGI_VOLUME_GATHER_GLSL
#include "propagation/neighbourhood.glsl"
#include "propagation/slots.shared.h"
#include "screen/base/gbuffer.glsl"
#include "shared/octahedral.glsl"
#include "voxel/seeing_cells.glsl"
#include "voxel/sides.glsl"

layout(std430, binding = DIRECT_IRRADIANCE_SLOT) readonly buffer DirectIrradiance { vec4 direct_irradiance[]; };
layout(std430, binding = INDIRECT_IRRADIANCE_SLOT) readonly buffer IndirectIrradiance { vec4 indirect_irradiance[]; };

uniform vec4 viewer;  // xyz position, w 1; or towards the viewer, w 0 (orthographic)

struct Gathered {
  vec3 direct;
  vec3 indirect;
  float weight;
};

// Sides of one cell. `point` (cell units) must lie in front of every surface that the cell sees.
void gather_cell(ivec3 cell, vec3 point, vec3 normal, float min_cosine, bool check_plane, float weight, inout Gathered g) {
  if (!cell_inside(grid, cell)) return;
  uvec2 own_sides = cell_sides[cell_index(grid, cell)];
  uint count = count_bits(own_sides.y & 63u);
  Gathered here = Gathered(vec3(0.0), vec3(0.0), 0.0);
  for (uint s = own_sides.x; s < own_sides.x + count; ++s) {
    vec3 side_normal = sides[s].normal;
    vec3 on_surface = vec3(cell) + 0.5;
    on_surface[sides[s].face >> 1] = sides[s].depth;
    if (check_plane && dot(point - on_surface, side_normal) < -1e-3) return;
    if (dot(side_normal, normal) < min_cosine) continue;
    float w = weight * sides[s].area_m2;
    here.direct += w * direct_irradiance[s].rgb;
    here.indirect += w * indirect_irradiance[s].rgb;
    here.weight += w;
  }
  g.direct += here.direct;
  g.indirect += here.indirect;
  g.weight += here.weight;
}

const uint ANY_CELL = 0xffffffffu;

// `open`: bits of reachable_cells around `from`, and no other cells; or ANY_CELL.
Gathered gather_around(vec3 point, vec3 normal, float min_cosine, bool check_plane, int reach, ivec3 from, uint open) {
  Gathered g = Gathered(vec3(0.0), vec3(0.0), 0.0);
  vec3 low = floor(point - 0.5);
  vec3 t = point - 0.5 - low;
  for (int z = -reach; z <= 1 + reach; ++z) {
    for (int y = -reach; y <= 1 + reach; ++y) {
      for (int x = -reach; x <= 1 + reach; ++x) {
        ivec3 cell = ivec3(low) + ivec3(x, y, z);
        ivec3 bit = cell - from + 1;
        if (open != ANY_CELL) {
          if (any(lessThan(bit, ivec3(0))) || any(greaterThan(bit, ivec3(2)))) continue;
          if (((open >> (bit.x + 3 * bit.y + 9 * bit.z)) & 1u) == 0u) continue;
        }
        vec3 d = abs(vec3(x, y, z) - t);
        vec3 w = max(vec3(1.0 + float(reach)) - d, vec3(0.0));
        gather_cell(cell, point, normal, min_cosine, check_plane, w.x * w.y * w.z + 1e-6, g);
      }
    }
  }
  return g;
}

// The eight cells around, of those that see the pixel.
Gathered gather_seeing(SeeingCells seeing, vec3 point, vec3 normal) {
  Gathered g = Gathered(vec3(0.0), vec3(0.0), 0.0);
  vec3 t = point - 0.5 - vec3(seeing.low);
  for (int k = 0; k < 8; ++k) {
    if (((seeing.joined >> k) & 1u) == 0u) continue;
    vec3 w = mix(1.0 - t, t, vec3(k & 1, (k >> 1) & 1, k >> 2));
    gather_cell(corner_cell(seeing, k), point, normal, SIMILAR_NORMAL_COSINE, true, w.x * w.y * w.z + 1e-6, g);
  }
  return g;
}

// @return its weight is 0 where there is nothing.
Gathered gather_pixel(vec3 position, vec3 normal) {
  // A touch towards the viewer, which is on the visible side of every surface: pixels in a line of contact, which the
  // rasterizer puts a fraction of a pixel behind the other surface, do not look at its dark side.
  // It moves the trilinear weights by at most 0.02.
  vec3 to_viewer = normalize(viewer.xyz - viewer.w * position);
  vec3 point = cell_from_world(grid, position) + 0.5 * normal + 0.02 * to_viewer;
  if (any(lessThan(point, vec3(-0.25))) || any(greaterThan(point, vec3(grid.cells) + 0.25))) {
    return Gathered(vec3(0.0), vec3(0.0), 0.0);  // faces the dark outside
  }
  // A surface too small or too tilted for the grid to show takes what is near, then what faces its way at
  // all, at last (rims of boards, thin rods) whatever surface is near.
  vec3 beside = point - (0.5 - 2.0 * HIDDEN_DEPTH) * normal;
  SeeingCells seeing = seeing_cells(point, beside, normal);
  Gathered g = Gathered(vec3(0.0), vec3(0.0), 0.0);
  if (seeing.nearest >= 0) {
    g = gather_seeing(seeing, point, normal);
    ivec3 from = corner_cell(seeing, seeing.nearest);
    if (!cell_inside(grid, from)) return g;  // the dark outside
    uint open = g.weight == 0.0 ? reachable_cells(from) : 0u;
    if (g.weight == 0.0) g = gather_around(point, normal, 0.70710678, true, 1, from, open);
    if (g.weight == 0.0) g = gather_around(point, normal, 0.0, true, 1, from, open);
    if (g.weight == 0.0) g = gather_around(point, normal, 0.0, false, 1, from, open);
  }
  if (g.weight == 0.0) g = gather_around(point, normal, 0.70710678, true, 1, ivec3(0), ANY_CELL);
  if (g.weight == 0.0) g = gather_around(point, normal, 0.0, true, 1, ivec3(0), ANY_CELL);
  if (g.weight == 0.0) g = gather_around(point, normal, 0.0, false, 1, ivec3(0), ANY_CELL);
  if (g.weight == 0.0) g = gather_around(point, normal, -1.0, true, 2, ivec3(0), ANY_CELL);
  return g;
}

#endif
