#ifndef VOLGI_RESAMPLE_SHARED_H
#define VOLGI_RESAMPLE_SHARED_H

#define RESAMPLE_RECEIVERS 256          // pixels that candidates are weighed by
#define RESAMPLE_FLOATS_PER_RECEIVER 8  // two vec4

#endif
