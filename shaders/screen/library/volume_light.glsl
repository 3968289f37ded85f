// Irradiance from a volume of light, for shaders of any program: screen::VolumeLight::bind() sets what is uniform here.
// GLSL 4.5 without includes of its own. `position` is in metres where the scene's triangles are, `normal` unit, on the
// side that is seen. A Lambertian surface of that albedo then sends albedo / pi times it [W m^-2 sr^-1], beside what it
// reflects of light straight from lamps.
#ifndef VOLGI_VOLUME_LIGHT_GLSL
#define VOLGI_VOLUME_LIGHT_GLSL

uniform sampler3D volgi_sh;     // coefficient c of the cell (i, j, k) at (i, j, k + c volgi_cells.z)
uniform vec3 volgi_cells;
uniform vec3 volgi_origin;      // of the grid [m]
uniform float volgi_cell_size;  // [m]
uniform int volgi_bands;        // of the spherical harmonics: 2 or 3

vec3 volgi_coefficient(vec3 cell, float c) {
  float coefficients = float(volgi_bands * volgi_bands);
  return texture(volgi_sh, (cell + vec3(0.0, 0.0, c * volgi_cells.z)) / (volgi_cells * vec3(1.0, 1.0, coefficients))).rgb;
}

// Bands 0, 1 and 2 by the cosine lobe's pi, 2 pi / 3 and pi / 4, half a cell in front of the surface, so that it is not lit
// from behind itself. Coefficients go by the direction in which light travels: from -normal.
vec3 volgi_irradiance(vec3 position, vec3 normal) {
  vec3 cell = (position - volgi_origin) / volgi_cell_size + 0.5 * normal;
  cell = clamp(cell, vec3(0.5), volgi_cells - 0.5);
  vec3 e = 0.88622693 * volgi_coefficient(cell, 0.0) -
           1.02332671 * (normal.y * volgi_coefficient(cell, 1.0) + normal.z * volgi_coefficient(cell, 2.0) +
                         normal.x * volgi_coefficient(cell, 3.0));
  if (volgi_bands > 2) {
    vec3 n = normal;
    e += 0.85808553 * (n.x * n.y * volgi_coefficient(cell, 4.0) + n.y * n.z * volgi_coefficient(cell, 5.0) +
                       n.x * n.z * volgi_coefficient(cell, 7.0)) +
         0.24770796 * (3.0 * n.z * n.z - 1.0) * volgi_coefficient(cell, 6.0) +
         0.42904276 * (n.x * n.x - n.y * n.y) * volgi_coefficient(cell, 8.0);
  }
  return max(e, vec3(0.0));
}

#endif
