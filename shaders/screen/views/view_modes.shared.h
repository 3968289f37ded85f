// What views show, as both compilers number it.
#ifndef VOLGI_VIEW_MODES_SHARED_H
#define VOLGI_VIEW_MODES_SHARED_H

// texture_view: channels
#define VIEW_RGB 0
#define VIEW_RED 1
#define VIEW_GREEN 2
#define VIEW_BLUE 3
#define VIEW_ALPHA 4
#define VIEW_LENGTH 5

// gbuffer_view
#define VIEW_ALBEDO 0
#define VIEW_SHADING_NORMAL 1
#define VIEW_GEOMETRIC_NORMAL 2
#define VIEW_DEPTH 3
#define VIEW_EMISSION 4
#define VIEW_OBJECT_ID 5

// voxel_view
#define VIEW_SIDE_INDIRECT 0
#define VIEW_SIDE_DIRECT 1
#define VIEW_SIDE_IRRADIANCE 2
#define VIEW_SIDE_ALBEDO 3
#define VIEW_SIDE_COVERAGE 4
#define VIEW_SIDE_NORMAL 5
#define VIEW_SIDE_EMISSION 6

// lights_view
#define VIEW_LIGHT_FLUX 0
#define VIEW_LIGHT_SOURCE 1
#define VIEW_LIGHT_CLUSTER 2

#endif
