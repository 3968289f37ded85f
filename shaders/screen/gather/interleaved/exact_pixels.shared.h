#ifndef VOLGI_EXACT_PIXELS_SHARED_H
#define VOLGI_EXACT_PIXELS_SHARED_H

#define ERROR_BINS 2048  // of a histogram of positive floats: an eighth of an octave each, at any scale
#define ERROR_TILE 64    // pixels on an edge, which a group counts; it has a thread for each column

#endif
