// The pieces of surface in a fragment's column of cells, one where each fine line along the triangle's axis meets it, by
// the cells that they lie in. The file that includes this says what to do with a piece (add_piece) and with a cell
// (end_cell). A cell may come in several heaps.
#include "voxel/lattice.glsl"
#include "voxel/surface_point.glsl"

// h^2: of the surface that one line stands for.
float piece_area() { return 1.0 / (9.0 * abs(v_normal[v_axis])); }

struct Heap {
  ivec3 cell;   // below 0: none yet
  uint pieces;  // bits fb%3 + 3 (fc%3) of their lines
  float area;   // stopped, in pieces
  float stopped;  // most
  vec3 albedo;    // times area
  vec3 radiosity;  // most
};
void add_piece(inout Heap heap, vec3 weights, float stopped);
void end_cell(Lines lines, Heap heap);

// Where the first of some pieces lies, cell units.
vec3 first_point(Lines lines, uint pieces) {
  int number = findLSB(pieces);
  ivec2 line = 3 * ivec2(gl_FragCoord.xy) + ivec2(number % 3, number / 3);
  return from_family(vec3(float(depth_at(lines, plane_at(lines, line))), (vec2(line) + 0.5) / 3.0), v_axis);
}

void visit_cells() {
  int axis = v_axis;
  ivec3 cells = in_family(grid.cells, axis);
  dvec3 p0 = dvec3(in_family(v_vertex[0], axis));
  dvec3 p1 = dvec3(in_family(v_vertex[1], axis));
  dvec3 p2 = dvec3(in_family(v_vertex[2], axis));
  Lines lines = make_lines(axis, p0, p1, p2, cross(p1 - p0, p2 - p0));
  ivec2 column = ivec2(gl_FragCoord.xy);
  ivec2 first = max(in_family(first_line(min(min(v_vertex[0], v_vertex[1]), v_vertex[2])), axis).yz, 3 * column);
  ivec2 last = min(in_family(last_line(max(max(v_vertex[0], v_vertex[1]), v_vertex[2])), axis).yz, 3 * column + 2);
  ivec2 line = first;
  while (line.y <= last.y) {
    Heap heap = Heap(ivec3(-1), 0u, 0.0, 0.0, vec3(0.0), vec3(0.0));
    while (line.y <= last.y) {
      dvec3 edges = edges_at(lines, line);
      double plane = plane_at(lines, line);
      int segment = segment_at(lines, plane);
      if (meets(edges) && segment >= 0 && segment < 3 * (cells.x + 1)) {
        float depth = float(depth_at(lines, plane));
        ivec3 cell = ivec3(clamp(int(floor(depth)), 0, cells.x - 1), column);
        vec3 weights = weights_at(lines, edges);
        float stopped = stopped_at(weights);
        if (stopped > 0.0) {
          if (heap.cell.x >= 0 && cell.x != heap.cell.x) break;
          heap.cell = cell;
          heap.pieces |= 1u << (line.x % 3 + 3 * (line.y % 3));
          heap.area += stopped;
          heap.stopped = max(heap.stopped, stopped);
          add_piece(heap, weights, stopped);
        }
      }
      if (++line.x > last.x) line = ivec2(first.x, line.y + 1);
    }
    if (heap.cell.x >= 0) {
      heap.cell = from_family(heap.cell, axis);
      end_cell(lines, heap);
    }
  }
}
