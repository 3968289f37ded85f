#ifndef VOLGI_VOXEL_GROUPS_SHARED_H
#define VOLGI_VOXEL_GROUPS_SHARED_H

#define VOXEL_GROUP 256  // cells or faces of a group
#define FACE_LANES 32    // that share out a group's faces in coverage, list_sides_fill

#endif
