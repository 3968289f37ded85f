// Irradiance of a virtual light at a subsplat.
#ifndef VOLGI_SUBSPLAT_LIGHT_GLSL
#define VOLGI_SUBSPLAT_LIGHT_GLSL
#include "screen/gather/subsplats/subsplat_receiver.glsl"
#include "shared/constants.glsl"
#include "shared/disk_to_point.shared.h"
#include "shared/virtual_light.shared.h"

// Over its flux [m^-2]. Nichols 2010, eq. 4.1, the disk-to-point form as printed. FORM_POINT: eq. 3.2, whose distance
// is kept from getting smaller than the disk; FORM_EXACT: shared/disk_to_point.shared.h.
float light_form(vec3 position, vec3 normal, float area_m2, Receiver at) {
  vec3 w = position - at.position;
  float squared = dot(w, w), along = dot(w, at.normal), height = -dot(w, normal);
  if (min(min(along, dot(w, at.geometric)), height) <= 0.0) return 0.0;
#if defined(FORM_EXACT)
  return disk_to_point(height, along, -dot(normal, at.normal), squared, area_m2);
#else
  float cosines = along * height / max(squared, 1e-30);
#if defined(FORM_POINT)
  return cosines / max(PI * squared, area_m2 + 1e-30);
#else
  return cosines / (PI * squared + area_m2);
#endif
#endif
}

#ifdef SHINES
#include "screen/base/brdf.glsl"
layout(binding = GBUFFER_DIFFUSE_UNIT) uniform sampler2D diffuse_map;
layout(binding = GBUFFER_MIRROR_UNIT) uniform sampler2D mirror_map;
uniform vec4 viewer;  // position and 1, or the direction towards an orthographic camera and 0

// Of light from there, what goes to the viewer over what would if the surface were matt with its albedo: eq. 3.2 and
// 4.5 with any BRDF. Upsampling ends in albedo / pi.
vec3 share_to_viewer(vec3 from, Receiver at) {
  vec3 to_light = normalize(from - at.position), to_viewer = normalize(viewer.xyz - at.position * viewer.w);
  vec4 diffuse = texelFetch(diffuse_map, at.pixel, 0), mirror = texelFetch(mirror_map, at.pixel, 0);
  Shine shine = Shine(diffuse.rgb, mirror.rgb, mirror.a, diffuse.a);
  vec3 matt = texelFetch(albedo_map, at.pixel, 0).rgb * (max(dot(at.normal, to_light), 1e-6) / PI);
  return reflected_to_viewer(shine, at.normal, to_viewer, to_light) / max(matt, vec3(1e-9));
}
#endif

vec3 light_at(vec3 position, vec3 normal, float area_m2, vec3 flux, Receiver at) {
  float form = light_form(position, normal, area_m2, at);
#ifdef SHINES
  if (form > 0.0) return flux * form * share_to_viewer(position, at);
#endif
  return flux * form;
}

vec3 light_at(VirtualLight light, Receiver at) {
  return light_at(light.position, light.normal, light.area_m2, light.flux, at);
}

#endif
