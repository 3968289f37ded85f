#ifndef VOLGI_SCREEN_VOXELS_SLOTS_SHARED_H
#define VOLGI_SCREEN_VOXELS_SLOTS_SHARED_H

#define VOXEL_BITS_IMAGE 0
#define VOXEL_BITS_UNIT 10

#define VOXEL_RUN 4  // texels on an edge of what wide ones hold, and samples that one look can stand for

#endif
