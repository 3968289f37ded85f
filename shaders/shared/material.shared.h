// Constants and texture units of materials: core/surface.cpp, gl::SceneBuffers and shared/material.glsl.
#ifndef VOLGI_MATERIAL_SHARED_H
#define VOLGI_MATERIAL_SHARED_H

// Alpha at the cutoff is opaque (glTF 2.0, 3.9.4), also where interpolation has rounded it down.
#define ALPHA_CUTOFF_SLACK 1e-4f

#define MATERIAL_BASE_COLOR_UNIT 0
#define MATERIAL_METALLIC_UNIT 1
#define MATERIAL_EMISSIVE_UNIT 2

#endif
