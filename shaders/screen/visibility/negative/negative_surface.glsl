// Where a candidate of negative_candidates.glsl lies.
#ifndef VOLGI_NEGATIVE_SURFACE_GLSL
#define VOLGI_NEGATIVE_SURFACE_GLSL
#include "screen/visibility/negative/passed_light.glsl"
#include "screen/visibility/negative/negative_candidates.glsl"

struct ExitSurface {
  vec3 position, normal;
  float area_m2;  // that the candidate stands for; 0: there is none
  ivec3 cell;     // of a side: that sees it
};

ExitSurface exit_surface_of_pixel(ivec2 pixel, float pixels) {
  vec4 position = texelFetch(position_map, pixel, 0);
  vec3 normal = octahedral_decode(texelFetch(normal_map, pixel, 0).zw);
  float area = position.w == 0.0 ? 0.0 : surface_m2_in_pixel(position.xyz, normal) * pixels;
  return ExitSurface(position.xyz, normal, area, ivec3(0));
}

#ifdef SIDES
// Light leaves bodies where it can go on: at sides of open cells.
ExitSurface exit_surface(int candidate) {
  Side side = sides[sides_by_block[candidate]];
  ivec3 cell = cell_coord(grid, side.cell);
  vec3 at = vec3(cell) + 0.5;
  at[side.face >> 1] = side.depth;
  float area = open_cells[side.cell] != 0u ? side.area_m2 : 0.0;
  return ExitSurface(world_from_cell(grid, at), side.normal, area, cell);
}
#else
ExitSurface exit_surface(int candidate) {
  ivec2 size = textureSize(position_map, 0);
  vec2 at = vec2(candidate % CANDIDATES_X, candidate / CANDIDATES_X) + 0.5;
  ivec2 pixel = ivec2(at / vec2(CANDIDATES_X, CANDIDATES_Y) * vec2(size));
  return exit_surface_of_pixel(pixel, float(size.x) * float(size.y) / float(CANDIDATES_X * CANDIDATES_Y));
}
#endif

#endif
