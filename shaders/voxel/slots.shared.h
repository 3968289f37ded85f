// Where the voxelization's shaders, and all that read the volume, find buffers and images.
#ifndef VOLGI_VOXEL_SLOTS_SHARED_H
#define VOLGI_VOXEL_SLOTS_SHARED_H

// VoxelGridGl::bind().
#define GRID_BLOCK 0
#define CELL_SIDES_SLOT 3
#define SIDES_SLOT 4
#define SIDE_COUNT_SLOT 5
// FaceWalkCells::bind().
#define WALK_CELLS_UNIT 11

// Drawing the scene: places of the buffers in lists in which each has one of every family that is bound at once.
#define KEY_LOW_PLACE 0
#define KEY_HIGH_PLACE 1
#define BLOCKED_PLACE 2   // mark
#define HAZE_PLACE 3      // mark
#define ENTRIES_PLACE 2   // write_surfaces
#define SURFACES_PLACE 3  // write_surfaces

#define NUMBER_KEY_LOW_SLOT 0
#define NUMBER_ENTRIES_SLOT 1
#define WANTED_SLOT 2  // number_surfaces, list_sides_offset

#define COVERAGE_BLOCKED_SLOT 0  // of the first axis; the others follow
#define COVERAGE_HAZE_SLOT 3
#define COVERAGE_KEY_LOW_SLOT 4
#define COVERAGE_SLOT 5

#define LIST_COVERAGE_SLOT 0  // of the first axis; the others follow
#define GROUP_TOTALS_SLOT 4

#define FILL_ENTRIES_SLOT 0
#define FILL_SURFACES_SLOT 1
#define FILL_COVERAGE_SLOT 2

#define AREA_FIXED_SLOT 0
#define AREA_ENTRIES_SLOT 1
#define AREA_SURFACES_SLOT 2

#define CELL_MARKS_SLOT 6  // cell_spread, white_pockets

#define CELL_SUMS_SLOT 0  // the first
#define NORMAL_OCCUPANCY_IMAGE 0
#define CELL_ALBEDO_IMAGE 1
#define CELL_EMISSION_IMAGE 2

#endif
