// Nodes from their parts.
#ifndef VOLGI_LIGHT_NODE_SUM_GLSL
#define VOLGI_LIGHT_NODE_SUM_GLSL
#include "screen/gather/multires/light_tree.glsl"
#include "shared/constants.glsl"
#include "shared/octahedral.glsl"

vec3 normal_of(LightNode node) { return octahedral_decode(unpackSnorm2x16(node.normal)); }

float weight_of(LightNode node) { return node.flux.r + node.flux.g + node.flux.b; }

LightNode dark_node() { return LightNode(vec3(0.0), 0.0, vec3(0.0), 0u, 0.0, 0.0, 0.0, 0, vec3(0.0), packHalf2x16(vec2(0.0, 1.0))); }

// A disk as it comes. A point in its plane sees nothing of it, nor does one that is lower than a thousandth of the edge of a light, which is sixteen such disks.
LightNode node_of_disk(vec3 position, float area_m2, vec3 flux, uint normal, int kind) {
  return LightNode(position, area_m2, flux, normal, area_m2, 0.0, 4e-3 * sqrt(area_m2), kind, vec3(0.0),
                   packHalf2x16(vec2(0.0, 1.0)));
}

float surface_m2_of(LightNode node) { return node.lesser_m2 < 0.0 ? node.area_m2 : node.lesser_m2; }
// Mean squared distance of its flux from its position; a square's is a sixth of its area.
float variance_m2_of(LightNode node) { return (node.lesser_m2 < 0.0 ? -node.lesser_m2 : node.area_m2) / (2.0 * PI); }
float mean_normal_of(LightNode node) { return unpackHalf2x16(node.turned).y; }
bool stays_apart(LightNode node) { return (node.kind & NODE_STAYS_APART) != 0; }

// Least length of the mean normal of a node that may stand for its parts: a twentieth of the flux may leave surfaces that
// stand upright on the others'. Without it a single stray sample would open all nodes above it.
#define LEAST_MEAN_NORMAL 0.95

float off_plane_m2(LightNode node) {
  float deviation = unpackHalf2x16(node.turned).x;
  return deviation * deviation * node.area_m2;
}

// Covariance of its flux in space [m^2].
mat3 covariance_of(LightNode node) {
  vec3 normal = normal_of(node);
  float variance_m2 = variance_m2_of(node), off_plane = min(off_plane_m2(node), variance_m2);
  float in_plane = 0.5 * (variance_m2 - off_plane) - 0.5 * dot(node.stretch, node.stretch);
  mat3 across = outerProduct(normal, normal);
  return in_plane * (mat3(1.0) - across) + off_plane * across + outerProduct(node.stretch, node.stretch);
}

// Its axes in the plane of `normal`, and how far it spans across that.
void set_spread(mat3 covariance, vec3 normal, float mean_normal, inout LightNode node) {
  vec3 t = normalize(cross(normal, abs(normal.x) < 0.7 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0)));
  vec3 b = cross(normal, t);
  float more = 0.5 * (dot(t, covariance * t) - dot(b, covariance * b)), mixed = dot(t, covariance * b);
  float length_2 = 2.0 * sqrt(more * more + mixed * mixed);
  float turn = 0.5 * atan(mixed, more);
  node.stretch = length_2 > 0.0 ? sqrt(length_2) * (cos(turn) * t + sin(turn) * b) : vec3(0.0);
  float off_plane = max(dot(normal, covariance * normal), 0.0);
  node.turned = packHalf2x16(vec2(sqrt(off_plane / max(node.area_m2, 1e-30)), mean_normal));
}

// Four parts, those without flux left out. Those of two kinds have no share together.
LightNode sum_of_nodes(LightNode parts[4]) {
  LightNode sum = dark_node();
  vec3 normal = vec3(0.0);
  float weight = 0.0, surface_m2 = 0.0;
  int kind = -1, cluster = 0;
  bool one_kind = true;
  for (int k = 0; k < 4; ++k) {
    float w = weight_of(parts[k]);
    if (!(w > 0.0)) continue;
    sum.position += w * parts[k].position;
    surface_m2 += surface_m2_of(parts[k]);
    cluster = parts[k].kind >> NODE_CLUSTER_SHIFT;
    sum.flux += parts[k].flux;
    normal += w * mean_normal_of(parts[k]) * normal_of(parts[k]);
    weight += w;
    int own_kind = parts[k].kind & NODE_KIND_BITS;
    one_kind = one_kind && (kind < 0 || kind == own_kind);
    kind = own_kind;
  }
  if (!(weight > 0.0)) return sum;
  sum.position /= weight;
  float mean_normal = length(normal) / weight;
  normal = mean_normal > 1e-3 ? normalize(normal) : vec3(0.0, 0.0, 1.0);
  sum.normal = packSnorm2x16(octahedral_encode(normal));
  float least_cosine = 1.0, rise = 3.0e38, moment = 0.0;
  mat3 covariance = mat3(0.0);
  for (int k = 0; k < 4; ++k) {
    float w = weight_of(parts[k]);
    if (!(w > 0.0)) continue;
    vec3 way = parts[k].position - sum.position;
    sum.radius_m = max(sum.radius_m, length(way) + parts[k].radius_m);
    moment += w * (dot(way, way) + variance_m2_of(parts[k]));
    covariance += w / weight * (covariance_of(parts[k]) + outerProduct(way, way));
    least_cosine = min(least_cosine, dot(normal_of(parts[k]), normal));
    rise = parts[k].rise_m == NO_FLAT_NODE ? NO_FLAT_NODE : min(rise, dot(way, normal) + parts[k].rise_m);
    one_kind = one_kind && !(stays_apart(parts[k]) && mean_normal_of(parts[k]) >= LEAST_MEAN_NORMAL);
  }
  sum.rise_m = least_cosine > 0.9999 ? rise : NO_FLAT_NODE;
  // The disk that is spread as they are, and no smaller than they are: it would be brighter.
  float spread_m2 = 2.0 * PI * moment / weight;
  sum.area_m2 = max(surface_m2, spread_m2);
  sum.lesser_m2 = spread_m2 < surface_m2 ? -max(spread_m2, 1e-30) : surface_m2;
  set_spread(covariance, normal, mean_normal, sum);
  bool apart = !one_kind || mean_normal < LEAST_MEAN_NORMAL;
  sum.kind = kind | (apart ? NODE_STAYS_APART : 0) | (cluster << NODE_CLUSTER_SHIFT);
  return sum;
}

#endif
