// Beside what ReflectiveShadowMap::bind() binds (shared/reflective_shadow_map.shared.h).
#ifndef VOLGI_PATCHES_SLOTS_SHARED_H
#define VOLGI_PATCHES_SLOTS_SHARED_H

#define PATCHES_SLOT 3
#define PATCH_RANGES_SLOT 4
#define CHOSEN_PATCHES_SLOT 0

#endif
