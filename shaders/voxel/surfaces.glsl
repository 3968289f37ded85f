// What the two cells of a face see of the surfaces nearest to them; entry 2k for the lower cell, 2k+1 for the upper one.
struct Surface {
  vec3 normal;  // towards the cell
  float depth;  // on the line through the cells' centres, cell units along the axis
  vec3 albedo;
  int front;  // 1: of the triangle
  vec3 radiosity;
  float area_m2;  // of its side, when it was last counted; 0: not yet (collect_area)
};
const uint NO_ENTRY = 0xffffffffu;
