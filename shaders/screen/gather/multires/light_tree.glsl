// The light tree as its passes and gathers find it: levels of nodes behind one another, the topmost first. Four nodes
// that follow on one another have one parent; the topmost ones belong to clusters, some for each.
#ifndef VOLGI_LIGHT_TREE_GLSL
#define VOLGI_LIGHT_TREE_GLSL
#include "screen/gather/multires/light_node.shared.h"
#include "screen/gather/multires/slots.shared.h"

uniform int top_level;
uniform int most_roots;  // that there is room for

// Behind (4^n - 1) / 3 times as many nodes as there are roots, n levels over it.
int first_of_level(int level) { return most_roots * (((1 << (2 * (top_level - level))) - 1) & 0x55555555); }

#endif
