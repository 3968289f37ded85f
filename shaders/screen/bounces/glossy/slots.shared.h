// Beside what VoxelGridGl::bind(), GBuffer::bind() and bind_shine() bind.
#ifndef VOLGI_GLOSSY_SLOTS_SHARED_H
#define VOLGI_GLOSSY_SLOTS_SHARED_H

#define GLOSSY_RADIOSITY_SLOT 6  // of every side
// Of the pass that makes it.
#define GLOSSY_PUNCTUAL_FLUX_SLOT 7
#define GLOSSY_EMITTED_FLUX_SLOT 8
#define GLOSSY_DIRECT_IRRADIANCE_SLOT 9
#define GLOSSY_INDIRECT_IRRADIANCE_SLOT 10
// Of the rays.
#define GLOSSY_LIGHTS_SLOT 7
#define GLOSSY_COUNTS_SLOT 8
#define GLOSSY_LIGHT_SIDES_SLOT 9
#define GLOSSY_SKY_UNIT 5
#define GLOSSY_DIRECT_IMAGE 0
#define GLOSSY_INDIRECT_IMAGE 1
#define GLOSSY_DIRECT_UNIT 5
#define GLOSSY_INDIRECT_UNIT 6

#endif
