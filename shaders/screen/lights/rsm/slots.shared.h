// Beside what ReflectiveShadowMap::bind() binds (shared/reflective_shadow_map.shared.h).
#ifndef VOLGI_RSM_LIGHTS_SLOTS_SHARED_H
#define VOLGI_RSM_LIGHTS_SLOTS_SHARED_H

#define SAMPLED_LIGHTS_SLOT 0
#define LIGHT_SAMPLES_SLOT 3
#define FLUX_PYRAMID_SLOT 4

#endif
