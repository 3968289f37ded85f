// Values per side kept in 2D textures: rows of 1024 sides, or of four times as many entries.
const int SIDE_ROW_BITS = 10;  // SIDES_A_ROW of transport_ordinates_gl.cpp

ivec2 side_texel(int side) { return ivec2(side & ((1 << SIDE_ROW_BITS) - 1), side >> SIDE_ROW_BITS); }
