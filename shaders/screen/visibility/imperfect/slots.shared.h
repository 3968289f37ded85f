// Where imperfect maps are made; gathers read them as maps of area lights (SHADOW_DISTANCE_UNIT).
#ifndef VOLGI_IMPERFECT_SLOTS_SHARED_H
#define VOLGI_IMPERFECT_SLOTS_SHARED_H

#define MAP_VIEWS_SLOT 1
#define OCCLUDER_POINTS_SLOT 2
#define IMPERFECT_DISTANCE_IMAGE 0

#endif
