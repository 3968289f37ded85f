// Where passes of several leaves find what they share, beside the G-buffer's textures (screen/base/gbuffer.shared.h).
#ifndef VOLGI_SCREEN_SLOTS_SHARED_H
#define VOLGI_SCREEN_SLOTS_SHARED_H

#define VIRTUAL_LIGHTS_SLOT 0
#define VIRTUAL_LIGHTS_BLOCK 0  // VIRTUAL_LIGHTS_PER_BLOCK of them
#define PIXEL_LIST_SLOT 0       // those that are gathered again

// SmoothPixels, beside PIXEL_LIST_SLOT: of all pictures, from these on.
#define SMOOTH_PICTURES 4
#define SMOOTH_IRRADIANCE_UNIT 3  // GBUFFER_UNITS
#define SMOOTH_IRRADIANCE_IMAGE 0
#define SMOOTH_STEP_IMAGE 4
#define SMOOTH_MEAN_SLOT 1

#endif
