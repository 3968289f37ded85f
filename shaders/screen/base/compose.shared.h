#ifndef VOLGI_COMPOSE_SHARED_H
#define VOLGI_COMPOSE_SHARED_H

#define COMPOSE_LAYERS 13  // and the G-buffer's three: as many textures as GL promises

#endif
