// Beside what the G-buffer and the choice of visibility bind.
#ifndef VOLGI_AREA_SLOTS_SHARED_H
#define VOLGI_AREA_SLOTS_SHARED_H

#define AREA_IRRADIANCE_IMAGE 0
#define AREA_MASK_IMAGE 1  // lights 0 ... 127; the others follow
#define AREA_STEP_IMAGE 3
#define AREA_RADIANCE_IMAGE 0
#define AREA_IRRADIANCE_UNIT 3
#define AREA_MASK_UNIT 4
#define AREA_LIST_SLOT 0
#define AREA_LIGHTS_SLOT 1
#define AREA_COUNTS_SLOT 2

#define AREA_MASK_LIGHTS 256  // a bit for each

#endif
