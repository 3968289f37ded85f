// The faces that the triangle of a fragment crosses in the fragment's column of cells. A face's fine lines are met one
// after the other and make one run; the file that includes this says what to do with a line (add_line) and with a face
// (end_face). A face may come in several runs.
#include "voxel/lattice.glsl"
#include "shared/side.shared.h"
#include "voxel/surface_point.glsl"

struct Run {
  ivec3 place;  // face, column; as the family counts; x below 0: no face yet
  uint blocked;  // bit part * 9 + fb%3 + 3 (fc%3): this part of the face's line is blocked
  uint low, high;  // keys
  uint haze;       // 2^16 times the sum of -ln(1-alpha)
};
void add_line(inout Run run, Lines lines, ivec2 line, dvec3 edges, double plane, int segment);
void end_face(int axis, Lines lines, Run run);

// The lines that a fragment looks at: rows, and in each the lines of a range that moves from row to row.
struct Patch {
  bool rows_along_b;  // else along c
  ivec2 rows;         // first and last
  vec2 range;         // first and last line of row 0
  float shift;        // to the next row
  ivec2 limits;       // of lines in any row
  int owner;          // only crossings that lie in this cell along the axis; below 0: all
};
ivec2 lines_of_row(Patch patch_, int row) {
  const float slack = 0.01;  // exact tests follow
  vec2 range = patch_.range + patch_.shift * float(row);
  return ivec2(max(int(ceil(range.x - slack)), patch_.limits.x), min(int(floor(range.y + slack)), patch_.limits.y));
}

bool owned(Lines lines, double plane, int owner, int cells) {
  return owner < 0 || clamp(int(floor(depth_at(lines, plane))), 0, cells - 1) == owner;
}

void visit(int axis, Lines lines, Patch patch_) {
  int cells = grid.cells[axis];
  int row = patch_.rows.x;
  ivec2 range = lines_of_row(patch_, row);
  int at = range.x;
  while (row <= patch_.rows.y) {
    Run run = Run(ivec3(-1), 0u, 0xffffffffu, 0xffffffffu, 0u);
    while (row <= patch_.rows.y) {
      ivec2 line = patch_.rows_along_b ? ivec2(row, at) : ivec2(at, row);
      dvec3 edges = edges_at(lines, line);
      double plane = plane_at(lines, line);
      int segment = segment_at(lines, plane);
      if (at <= range.y && meets(edges) && segment >= 0 && segment < 3 * (cells + 1) &&
          owned(lines, plane, patch_.owner, cells)) {
        ivec3 place = ivec3(segment / 3, line / 3);
        if (run.place.x >= 0 && place != run.place) break;
        run.place = place;
        add_line(run, lines, line, edges, plane, segment);
      }
      if (++at > range.y) {
        range = lines_of_row(patch_, ++row);
        at = range.x;
      }
    }
    if (run.place.x >= 0) end_face(axis, lines, run);
  }
}

Lines lines_of(int axis) {
  dvec3 p0 = dvec3(in_family(v_vertex[0], axis));
  dvec3 p1 = dvec3(in_family(v_vertex[1], axis));
  dvec3 p2 = dvec3(in_family(v_vertex[2], axis));
  return make_lines(axis, p0, p1, p2, cross(p1 - p0, p2 - p0));
}

ivec3 lowest() { return min(min(v_vertex[0], v_vertex[1]), v_vertex[2]); }
ivec3 highest() { return max(max(v_vertex[0], v_vertex[1]), v_vertex[2]); }

// Slicing: the nine lines of the fragment's column. A triangle seen edge-on meets none: its edges cannot all be above 0.
void visit_column(int axis) {
  ivec2 column = ivec2(gl_FragCoord.xy);
  ivec2 first = max(in_family(first_line(lowest()), axis).yz, 3 * column);
  ivec2 last = min(in_family(last_line(highest()), axis).yz, 3 * column + 2);
  visit(axis, lines_of(axis), Patch(false, ivec2(first.y, last.y), vec2(first.x, last.x), 0.0, ivec2(first.x, last.x), -1));
}

// Single pass: the column runs along the longest axis of the triangle's normal, x here. Besides its own nine lines, the
// fragment looks at the lines along y and z whose crossing with the triangle's plane lies in its column; a plane less
// steep than 45 degrees along both leaves at most four of them in a row. Rounding decides whose a crossing on the rim is,
// for all fragments alike.
void visit_three_families() {
  ivec2 column = ivec2(gl_FragCoord.xy);
  ivec3 cells = in_family(grid.cells, v_axis);
  ivec3 first = max(in_family(first_line(lowest()), v_axis), ivec3(0, 3 * column));
  ivec3 last = min(in_family(last_line(highest()), v_axis), ivec3(3 * cells.x - 1, 3 * column + 2));
  dvec3 p = dvec3(in_family(v_vertex[0], v_axis) - NODE_STEPS / 2) / double(NODE_STEPS);  // in lines
  dvec3 n = in_family(cross(dvec3(v_vertex[1] - v_vertex[0]), dvec3(v_vertex[2] - v_vertex[0])), v_axis);
  vec2 slope = vec2(-n.yz / n.x);
  float at_zero = float(dot(n, p) / n.x);  // line of x at lines 0 of y and z
  // The column's rim, in lines; what lies up to half a cell outside the grid belongs to the outermost columns.
  vec2 rim_low = vec2(3 * column) - mix(vec2(0.5), vec2(3.5), equal(column, ivec2(0)));
  vec2 rim_high = vec2(3 * column) + mix(vec2(2.5), vec2(5.5), equal(column, cells.yz - 1));
  for (int axis = 0; axis < 3; ++axis) {
    int role = (axis - v_axis + 3) % 3;
    Patch patch_ = Patch(false, ivec2(first.z, last.z), vec2(first.y, last.y), 0.0, ivec2(first.y, last.y), -1);
    if (role == 1) {
      vec2 ends = at_zero + slope.x * vec2(rim_low.x, rim_high.x);
      patch_ = Patch(true, ivec2(first.z, last.z), vec2(min(ends.x, ends.y), max(ends.x, ends.y)), slope.y,
                     ivec2(first.x, last.x), column.x);
    } else if (role == 2) {
      vec2 ends = at_zero + slope.y * vec2(rim_low.y, rim_high.y);
      patch_ = Patch(false, ivec2(first.y, last.y), vec2(min(ends.x, ends.y), max(ends.x, ends.y)), slope.x,
                     ivec2(first.x, last.x), column.y);
    }
    visit(axis, lines_of(axis), patch_);
  }
}
