// Beside what the G-buffer and the choice of visibility bind.
#ifndef VOLGI_AREA_SLOTS_SHARED_H
#define VOLGI_AREA_SLOTS_SHARED_H

#define AREA_IRRADIANCE_IMAGE 0
#define AREA_MASK_IMAGE 1
#define AREA_STEP_IMAGE 2
#define AREA_RADIANCE_IMAGE 0
#define AREA_IRRADIANCE_UNIT 5
#define AREA_MASK_UNIT 6
#define AREA_SHARED_UNIT 7
#define AREA_STEP_UNIT 8
#define AREA_LIST_SLOT 0
#define AREA_LIGHTS_SLOT 1
#define AREA_COUNTS_SLOT 2
#define AREA_QUESTIONS_SLOT 3  // of the host's rays
#define AREA_ASKERS_SLOT 4

// Of what lobes reflect; ways are three textures or images each.
#define AREA_LOBE_KIND_IMAGE 0
#define AREA_LOBE_WAYS_IMAGE 1
#define AREA_LOBE_KIND_UNIT 7
#define AREA_LOBE_WAYS_UNIT 12
#define AREA_PANELS_UNIT 8
#define AREA_PANELS_SLOT 0

#define AREA_GROUPS 64  // of lights that follow on one another; a pixel has two bits for each
#define AREA_SHARES 4   // of each group's lights, for 2 x 2 pixels

#endif
