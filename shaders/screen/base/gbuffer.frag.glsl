#version 450 core
// What the camera sees at the centre of each pixel. Both normals are turned to the viewer's side of the triangle.
// Set by the program: SHINES, where some material is not Lambertian; PHONG, where mirrors are Phong lobes
#define MATERIAL_TINTED
#include "shared/material.glsl"
#include "shared/octahedral.glsl"

uniform vec4 viewer;  // position and 1, or the direction towards an orthographic camera and 0

in vec3 position;
in vec3 shading_normal;
in vec2 uv0;
in vec2 uv1;
in vec4 color;
flat in vec3 geometric_normal;
flat in uint object_id;

layout(location = 0) out vec4 out_position;  // w = 1: there is geometry
layout(location = 1) out vec4 out_normals;   // octahedral: shading, geometric
layout(location = 2) out vec4 out_albedo;
layout(location = 3) out vec4 out_emission;  // radiance towards the viewer
layout(location = 4) out uint out_object_id;
#ifdef SHINES
layout(location = 5) out vec4 out_diffuse;  // and perceptual roughness
layout(location = 6) out vec4 out_mirror;   // reflectance from in front, and at grazing angles
layout(binding = DIRECTIONAL_ALBEDO_UNIT) uniform sampler2D directional_albedo;

uniform float least_mirror_apart;

// Of even light, all that goes to the viewer: by directional_albedo.h, and what of Schlick's (1 - v.h)^5 a diffuse
// surface sees in the mean (a polynomial of the cosine, within 4e-6). Alpha: the share of the mirror that is in it.
vec4 albedo_to_viewer(Reflectance r, float roughness, float cosine) {
  float c = clamp(cosine, 0.0, 1.0);
  float grazing = (((0.00907138 * c - 0.04386464) * c + 0.08659765) * c - 0.07987975) * c + 0.02815884;
  float front = max(max(r.at_0.r, r.at_0.g), r.at_0.b);
  vec2 mirror = textureLod(directional_albedo, vec2(c, clamp(roughness, 0.0, 1.0)), 0.0).rg;
  vec3 facets = r.at_0 * mirror.x + vec3(r.at_90 * mirror.y);
  // From none to all of it within as much again, so that no edge shows.
  float apart = max(max(facets.r, facets.g), facets.b) / max(least_mirror_apart, 1e-4) - 1.0;
  float kept = 1.0 - clamp(apart, 0.0, 1.0);
  vec3 diffuse = r.diffuse * (1.0 - (front + (r.at_90 - front) * grazing));
  return vec4(diffuse + kept * facets, kept);
}
#endif

uniform int material_normal_texcoord;  // as the others'
uniform mat3 material_normal_transform;
uniform float material_normal_scale;
layout(binding = MATERIAL_NORMAL_UNIT) uniform sampler2D material_normal_texture;

// The shading normal after the material's normal map. Tangents along its texture coordinates, by what changes from
// pixel to pixel. CPU twin: mapped_normal() of core/surface.cpp.
vec3 mapped_normal(vec3 n) {
  vec2 uv = material_normal_texcoord == 0 ? uv0 : uv1;
  vec3 e1 = dFdx(position), e2 = dFdy(position);
  vec2 d1 = dFdx(uv), d2 = dFdy(uv);
  // Where the picture's axes turn the other way than the surface's front, both do: the sign of the two together counts.
  float turned = (d1.x * d2.y - d2.x * d1.y) * (dot(cross(e1, e2), geometric_normal) < 0.0 ? -1.0 : 1.0);
  float side = turned < 0.0 ? 1.0 : -1.0;  // v grows downwards in the picture, green upwards
  vec3 tangent = (e1 * d2.y - e2 * d1.y) * (d1.x * d2.y - d2.x * d1.y < 0.0 ? -1.0 : 1.0);
  tangent -= n * dot(n, tangent);
  if (turned == 0.0 || dot(tangent, tangent) == 0.0) return n;
  tangent = normalize(tangent);
  vec3 bitangent = cross(n, tangent) * side;
  vec3 texel = texture(material_normal_texture, (material_normal_transform * vec3(uv, 1.0)).xy).rgb * 2.0 - 1.0;
  vec3 mapped = material_normal_scale * (texel.x * tangent + texel.y * bitangent) + texel.z * n;
  return dot(mapped, geometric_normal) > 0.0 ? normalize(mapped) : n;
}

void main() {
  vec4 base = material_base(uv0, uv1, color);
  bool front = dot(geometric_normal, viewer.xyz - position * viewer.w) >= 0.0;
  vec3 geometric = front ? geometric_normal : -geometric_normal;
  vec3 shading = length(shading_normal) > 0.0 ? normalize(shading_normal) : geometric_normal;
  if (dot(shading, geometric_normal) < 0.0) shading = -shading;
  if (material_normal_texcoord >= 0) shading = mapped_normal(shading);
  if (!front) shading = -shading;
  out_position = vec4(position, 1.0);
  out_normals = vec4(octahedral_encode(shading), octahedral_encode(geometric));
  Reflectance reflectance;
  float roughness = material_reflectance(base.rgb, uv0, uv1, reflectance);
#ifdef SHINES
#ifdef PHONG
  reflectance.at_90 = max(max(reflectance.at_0.r, reflectance.at_0.g), reflectance.at_0.b);  // no Fresnel
#endif
  vec3 to_viewer = normalize(viewer.xyz - position * viewer.w);
  out_albedo = albedo_to_viewer(reflectance, roughness, dot(shading, to_viewer));
  out_diffuse = vec4(reflectance.diffuse, clamp(roughness, 0.0, 1.0));
  out_mirror = vec4(reflectance.at_0, reflectance.at_90);
#else
  out_albedo = vec4(surface_albedo(reflectance, roughness), 1.0);
#endif
  bool emits = front || material_double_sided != 0;
  out_emission = vec4(emits ? material_emission(uv0, uv1) : vec3(0.0), 1.0);
  if (material_unlit != 0) out_emission.rgb = base.rgb;
  out_object_id = object_id;
  // Last: what changes from pixel to pixel is not known any more behind it.
  if (!material_keeps(base.a, uvec3(gl_FragCoord.xy, object_id * 65599u + uint(gl_PrimitiveID)))) discard;
}
