// Light of the sub-lights of virtual lights on what is near those (shared/near_light.shared.h). The including file
// defines SUBLIGHTS_SLOT, where their buffer is bound.
#ifndef VOLGI_SUBLIGHTS_GLSL
#define VOLGI_SUBLIGHTS_GLSL
#include "shared/disk_to_point.shared.h"
#include "shared/near_light.shared.h"
#include "shared/octahedral.glsl"

// SubLight in two halves each: software rasterizers load vectors whole.
layout(std430, binding = SUBLIGHTS_SLOT) readonly buffer SubLights { vec4 sublight_halves[]; };

#ifdef FROM_AFAR  // `zone` is DISK_FAR_AREAS at least, so that coarse sub-lights are
#define COARSE_DISK_TO_POINT disk_to_point_from_afar
#else
#define COARSE_DISK_TO_POINT disk_to_point
#endif

#define FINE_PER_COARSE (FINE_SUBLIGHTS / COARSE_SUBLIGHTS)

struct Receiver {
  vec3 position, normal, geometric;
};

// One of them as a point sees it.
struct Disk {
  float height, along, facing, squared, area_m2;  // disk_to_point()
  vec3 flux;  // none where the point does not see it
};

Disk disk_of(Receiver at, int p) {
  vec4 first = sublight_halves[2 * p], second = sublight_halves[2 * p + 1];
  vec3 w = first.xyz - at.position;
  vec3 normal = octahedral_decode(unpackSnorm2x16(floatBitsToUint(second.w)));
  float along = dot(w, at.normal);
  vec3 flux = min(along, dot(w, at.geometric)) > 0.0 ? second.xyz : vec3(0.0);
  return Disk(max(-dot(w, normal), 0.0), along, -dot(normal, at.normal), dot(w, w), first.w, flux);
}

vec3 irradiance_of_fine(Receiver at, int p) {
  Disk d = disk_of(at, p);
  return d.flux * disk_to_point(d.height, d.along, d.facing, d.squared, d.area_m2);
}

vec3 irradiance_of_coarse(Receiver at, int light, int coarse, float zone) {
  int first = light * SUBLIGHTS_PER_LIGHT;
  Disk d = disk_of(at, first + coarse);
  float far = far_share(disk_nearness(d.squared, d.area_m2), zone);
  float form = far > 0.0 ? COARSE_DISK_TO_POINT(d.height, d.along, d.facing, d.squared, d.area_m2) : 0.0;
  vec3 whole = d.flux * form;
  int first_fine = first + COARSE_SUBLIGHTS + coarse * FINE_PER_COARSE;
  int fine_count = far < 1.0 ? FINE_PER_COARSE : 0;  // software rasterizers run both sides of a branch, but leave loops
  vec3 sum = vec3(0.0);
  for (int k = 0; k < fine_count; ++k) sum += irradiance_of_fine(at, first_fine + k);
  return mix(sum, whole, far);
}

// The same where every part has a share by its own place (VirtualLightSubdivision::apart()): the light may
// lie anywhere in what it stands for, and the nearer to the point the brighter it is and the less of it counts, so that
// means over many lights would come out too dark.
// @param area_m2  of the light. @param coarse_count  0: nothing is done.
vec3 irradiance_of_sublights_apart(Receiver at, int light, float area_m2, int coarse_count, float zone) {
  int first = light * SUBLIGHTS_PER_LIGHT;
  float reach = sqrt(2.0 * zone * area_m2);  // beyond it a part has no share
  vec3 sum = vec3(0.0);
  for (int coarse = 0; coarse < coarse_count; ++coarse) {
    vec4 place = sublight_halves[2 * (first + coarse)];
    vec3 way = place.xyz - at.position;
    float squared = dot(way, way);
    float far = far_share(disk_nearness(squared, place.w), zone);
    float own = 1.0 - far_share(disk_nearness(squared, area_m2), zone);
    // Loops where branches are meant, as above.
    int whole = far * own > 0.0 ? 1 : 0;
    for (int k = 0; k < whole; ++k) {
      Disk d = disk_of(at, first + coarse);
      sum += d.flux * (far * own * COARSE_DISK_TO_POINT(d.height, d.along, d.facing, d.squared, d.area_m2));
    }
    int first_fine = first + COARSE_SUBLIGHTS + coarse * FINE_PER_COARSE;
    float fine_reach = reach + sqrt(2.0 * place.w);  // of_one_surface()
    int fine_count = far < 1.0 && squared < fine_reach * fine_reach ? FINE_PER_COARSE : 0;
    for (int k = 0; k < fine_count; ++k) {
      vec3 fine_way = sublight_halves[2 * (first_fine + k)].xyz - at.position;
      int reached = dot(fine_way, fine_way) < reach * reach ? 1 : 0;
      for (int n = 0; n < reached; ++n) {
        Disk f = disk_of(at, first_fine + k);
        own = (1.0 - far) * (1.0 - far_share(disk_nearness(f.squared, area_m2), zone));
        sum += f.flux * (own * disk_to_point(f.height, f.along, f.facing, f.squared, f.area_m2));
      }
    }
  }
  return sum;
}

// @param share  of the light's irradiance that is theirs; nothing is done for 0.
vec3 irradiance_of_sublights(Receiver at, int light, float share, float zone) {
  int coarse_count = share > 0.0 ? COARSE_SUBLIGHTS : 0;
  vec3 sum = vec3(0.0);
  for (int coarse = 0; coarse < coarse_count; ++coarse) sum += irradiance_of_coarse(at, light, coarse, zone);
  return share * sum;
}

#endif
