// Where the shaders of propagation find buffers, textures and images, beside what VoxelGridGl::bind() binds
// (voxel/slots.shared.h). Powers are of every side.
#ifndef VOLGI_PROPAGATION_SLOTS_SHARED_H
#define VOLGI_PROPAGATION_SLOTS_SHARED_H

// A transport, and the orders that it carries.
#define RECEIVED_SLOT 6
#define SENT_SLOT 7
#define TOTAL_SLOT 8
#define SOURCE_SLOT 9
#define PARTIALS_SLOT 10
#define SUM_SLOT 11

// The solver of all bounces, which has the slots above too.
#define STATE_SLOT 11
#define RESIDUAL_SLOT 12
#define FIRST_ARRIVAL_SLOT 13
#define SOURCE_PUNCTUAL_SLOT 14
#define LAST_COUNT_SLOT 14

// The light that comes in: into SOURCE_SLOT.
#define LOST_SLOT 11
#define FLUX_FIXED_SLOT 12
#define FLUX_LOST_SLOT 13
#define PIECES_SLOT 14

// What the bounces have come to (answer.glsl), and what is made of it.
#define TOTAL_DIRECT_SLOT 6
#define TOTAL_INDIRECT_SLOT 7
#define EMITTED_FLUX_SLOT 8
#define PUNCTUAL_FLUX_SLOT 9
#define TOTAL_SENT_SLOT 10
#define WEIGHTED_DIRECT_SLOT 10
#define WEIGHTED_INDIRECT_SLOT 11
#define DIRECT_IRRADIANCE_SLOT 6
#define INDIRECT_IRRADIANCE_SLOT 7

// Lobes, of `conservative` and of pulses.
#define LOBES_UNIT 0
#define ACCUMULATED_UNIT 1
#define NORMAL_OCCUPANCY_UNIT 2
#define CELL_ALBEDO_UNIT 3
#define CELL_EMISSION_UNIT 3
#define NEXT_LOBES_IMAGE 0
#define NEXT_ACCUMULATED_IMAGE 1
#define LOBES_RADIANCE_IMAGE 0
#define SIDE_FLUX_SLOT 7

// `ordinates`: prepare_sweep's images are the sweeps' textures.
#define CELL_WORD_IMAGE 0
#define SIDE_LIGHT_IMAGE 1
#define CELL_WORD_UNIT 1
#define SIDE_LIGHT_UNIT 2

#define BLOCK_LIST_UNIT 3
#define SHARES_SLOT 6
#define INFLOW_SLOT 8
#define FACES_IMAGE 0  // across x; those across y and z follow
#define ARRIVED_IMAGE 3
#define ARRIVED_UNIT 0

#define SHARES_BLOCK 1
#define BEFORE_PLANE_UNIT 0
#define COLUMN_MAP_UNIT 3
#define THIS_PLANE_IMAGE 0
#define SWEEP_RADIANCE_IMAGE 1

#endif
