// Beside what ReflectiveShadowMap::bind() binds (shared/reflective_shadow_map.shared.h).
#ifndef VOLGI_LATTICE_SLOTS_SHARED_H
#define VOLGI_LATTICE_SLOTS_SHARED_H

#define LATTICE_LIGHTS_SLOT 0
#define LATTICE_SUMS_SLOT 3
#define LATTICE_ON_SLOT 4

#endif
