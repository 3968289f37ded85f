#ifndef VOLGI_EXPOSURE_METER_SHARED_H
#define VOLGI_EXPOSURE_METER_SHARED_H

#define METERED_EDGE 64  // samples on each side of the picture
#define METERED_RADIANCE_UNIT 0
#define METERED_SAMPLES_SLOT 0

#endif
