// Exact geometry of a triangle and the lines of the fine lattice along one axis, in steps of slice_vertex: integers in
// double precision. Nodes count as moved by (e, e^2, e^3), e above 0 but next to nothing, so that none lies on an edge or
// a plane (simulation of simplicity, Edelsbrunner and Muecke 1990): doubled and with the direction of the move added, no
// sign below is ever 0. Numbers stay under 2^53 up to 256 cells.
#include "voxel/families.glsl"

struct Lines {
  dvec3 edge, edge_b, edge_c;  // line (fb, fc) meets the triangle where edge + fb edge_b + fc edge_c are all above 0
  dvec3 edge_tie;              // what the move adds to edge
  double plane, plane_b, plane_c;  // negative where the line's first node, half a cell before the grid, is below the surface
  double plane_tie;
  double per_segment;  // 1 / what a node further along adds to plane
  double per_area;     // 1 / sum of the three edges
};

double first_sign(double a, double b) { return a != 0.0lf ? sign(a) : sign(b); }

// Corners and their cross product as the family counts them. The product along the axis must not be 0.
Lines make_lines(int axis, dvec3 p0, dvec3 p1, dvec3 p2, dvec3 n) {
  double facing = n.x > 0.0lf ? 1.0lf : -1.0lf;
  dvec3 eb = facing * dvec3(p2.y - p1.y, p0.y - p2.y, p1.y - p0.y);
  dvec3 ec = facing * dvec3(p2.z - p1.z, p0.z - p2.z, p1.z - p0.z);
  double at = double(NODE_STEPS / 2);  // of line 0
  Lines lines;
  for (int e = 0; e < 3; ++e) {  // a step along b adds -ec to the area, one along c adds eb; the lower axis moves more
    lines.edge_tie[e] = axis == 1 ? first_sign(eb[e], -ec[e]) : first_sign(-ec[e], eb[e]);
  }
  lines.edge = 2.0lf * (eb * (at - dvec3(p1.z, p2.z, p0.z)) - ec * (at - dvec3(p1.y, p2.y, p0.y))) + lines.edge_tie;
  lines.edge_b = -2.0lf * double(NODE_STEPS) * ec;
  lines.edge_c = 2.0lf * double(NODE_STEPS) * eb;
  dvec3 xyz = from_family(n, axis);
  lines.plane_tie = facing * (xyz.x != 0.0lf ? sign(xyz.x) : first_sign(xyz.y, xyz.z));
  dvec3 m = 2.0lf * facing * n;
  lines.plane = dot(m, dvec3(-double(SLICE_STEPS / 2), at, at) - p0) + lines.plane_tie;
  lines.plane_b = double(NODE_STEPS) * m.y;
  lines.plane_c = double(NODE_STEPS) * m.z;
  lines.per_segment = 1.0lf / (double(NODE_STEPS) * m.x);
  lines.per_area = 1.0lf / m.x;
  return lines;
}

dvec3 edges_at(Lines lines, ivec2 line) {
  return lines.edge + double(line.x) * lines.edge_b + double(line.y) * lines.edge_c;
}
bool meets(dvec3 edges) { return min(min(edges.x, edges.y), edges.z) > 0.0lf; }
// Barycentric weights of the corners.
vec3 weights_at(Lines lines, dvec3 edges) { return vec3((edges - lines.edge_tie) * lines.per_area); }

double plane_at(Lines lines, ivec2 line) {
  return lines.plane + double(line.x) * lines.plane_b + double(line.y) * lines.plane_c;
}
// The segment, three a face, that the surface lies in: the one behind the last node below it. The quotient is at least
// 2^-42 from any integer, further than it can be rounded.
int segment_at(Lines lines, double plane) { return int(floor(-plane * lines.per_segment)); }
// Where the surface is, in cell units along the axis.
double depth_at(Lines lines, double plane) {
  return (lines.plane_tie - plane) * lines.per_segment * (1.0lf / 3.0lf) - 0.5lf;
}
