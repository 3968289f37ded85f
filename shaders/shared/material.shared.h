// Texture units of a material: gl::SceneBuffers and shared/material.glsl.
#ifndef VOLGI_MATERIAL_SHARED_H
#define VOLGI_MATERIAL_SHARED_H

#define MATERIAL_BASE_COLOR_UNIT 0
#define MATERIAL_METALLIC_UNIT 1
#define MATERIAL_EMISSIVE_UNIT 2

#endif
