#ifndef VOLGI_COMPOSE_SHARED_H
#define VOLGI_COMPOSE_SHARED_H
#include "screen/base/gbuffer.shared.h"

#define COMPOSE_LAYERS 13  // and the G-buffer's three: as many textures as GL promises
#define COMPOSE_LAYERS_UNIT GBUFFER_UNITS

#endif
