// What discontinuity mipmaps say of a square of the picture: screen/gather/subsplats/discontinuity_mipmaps.h.
#ifndef VOLGI_DISCONTINUITY_SHARED_H
#define VOLGI_DISCONTINUITY_SHARED_H

#define SUBSPLAT_DISCONTINUOUS 1
#define SUBSPLAT_HAS_SURFACE 2
#define FAR_AWAY 3.0e38f  // depth of the background

#endif
