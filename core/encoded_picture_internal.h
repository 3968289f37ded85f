#pragma once
// stb_image (2.27, Debian 12) believes what a file says of its own sizes: what it would read is looked at first.
#include <cstddef>
#include <cstdint>
#include <span>

namespace volgi {

using EncodedPicture = std::span<const unsigned char>;

/// Whether no Huffman table of a JPEG has more codes than there are symbols: stb_image would write beyond its own.
bool jpeg_tables_fit(EncodedPicture jpeg);
/// Whether no chunk of a PNG is longer than what is left of the file: stb_image would make room for it.
bool png_chunks_fit(EncodedPicture png);
/// Whether so many pixels may be made of so many bytes: pictures of one colour pack well, but memory has to be bounded
/// by what the file is.
bool pixels_fit(std::int64_t pixels, size_t bytes);

}  // namespace volgi
