// stb_image (2.27, Debian 12) believes how many codes a JPEG's Huffman table has and writes beyond its own: what it
// would read is looked at first.
#include <algorithm>

#include "core/gltf/gltf_internal.h"

namespace volgi::gltf {
namespace {

// ITU-T T.81, table B.1
constexpr unsigned DHT = 0xc4, SOI = 0xd8, EOI = 0xd9, SOS = 0xda, RST0 = 0xd0, RST7 = 0xd7;

size_t length_at(Bytes jpeg, size_t at) {
  return at + 2 <= jpeg.size ? size_t(jpeg.data[at]) * 256 + jpeg.data[at + 1] : 0;
}

/// Of a segment from its tables on: a byte, the numbers of codes of 1 ... 16 bits, a byte for each code. Behind the
/// file's end the decoder reads zeros.
bool codes_fit(Bytes jpeg, size_t at, size_t end) {
  constexpr size_t most_codes = 256, head = 17;
  while (at < std::min(end, jpeg.size)) {
    size_t codes = 0;
    for (size_t i = at + 1; i < std::min(at + head, jpeg.size); ++i) codes += jpeg.data[i];
    if (codes > most_codes) return false;
    at += head + codes;
  }
  return true;
}

/// Behind the next marker's two bytes, whatever lies before it; the end where there is none.
size_t next_marker(Bytes jpeg, size_t at, bool in_scan, unsigned& marker) {
  for (; at + 1 < jpeg.size; ++at) {
    marker = jpeg.data[at + 1];
    const bool data = in_scan && (marker == 0 || (marker >= RST0 && marker <= RST7));
    if (jpeg.data[at] == 0xff && marker != 0xff && !data) return at + 2;
  }
  return jpeg.size;
}

}  // namespace

bool jpeg_tables_fit(Bytes jpeg) {
  unsigned marker = SOI;
  for (size_t at = 2; at < jpeg.size;) {
    at = next_marker(jpeg, at, marker == SOS, marker);
    if (marker == EOI) return true;
    const size_t length = length_at(jpeg, at);
    if (length < 2) return true;  // which the decoder refuses
    if (marker == DHT && !codes_fit(jpeg, at + 2, at + length)) return false;
    at += length;
  }
  return true;
}

}  // namespace volgi::gltf
