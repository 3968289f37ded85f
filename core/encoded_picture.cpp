#include <algorithm>

#include "core/encoded_picture_internal.h"

namespace volgi {
namespace {

// ITU-T T.81, table B.1
constexpr unsigned DHT = 0xc4, SOI = 0xd8, EOI = 0xd9, SOS = 0xda, RST0 = 0xd0, RST7 = 0xd7;

/// Of `count` bytes, the highest first; 0 where they are not there.
size_t number_at(EncodedPicture picture, size_t at, size_t count) {
  size_t number = 0;
  for (size_t i = at; i < at + count; ++i) number = i < picture.size() ? 256 * number + picture[i] : 0;
  return number;
}

/// Of a segment from its tables on: a byte, the numbers of codes of 1 ... 16 bits, a byte for each code. Behind the
/// file's end the decoder reads zeros.
bool codes_fit(EncodedPicture jpeg, size_t at, size_t end) {
  constexpr size_t most_codes = 256, head = 17;
  while (at < std::min(end, jpeg.size())) {
    size_t codes = 0;
    for (size_t i = at + 1; i < std::min(at + head, jpeg.size()); ++i) codes += jpeg[i];
    if (codes > most_codes) return false;
    at += head + codes;
  }
  return true;
}

/// Behind the next marker's two bytes, whatever lies before it; the end where there is none.
size_t next_marker(EncodedPicture jpeg, size_t at, bool in_scan, unsigned& marker) {
  for (; at + 1 < jpeg.size(); ++at) {
    marker = jpeg[at + 1];
    const bool data = in_scan && (marker == 0 || (marker >= RST0 && marker <= RST7));
    if (jpeg[at] == 0xff && marker != 0xff && !data) return at + 2;
  }
  return jpeg.size();
}

}  // namespace

bool jpeg_tables_fit(EncodedPicture jpeg) {
  unsigned marker = SOI;
  for (size_t at = 2; at < jpeg.size();) {
    at = next_marker(jpeg, at, marker == SOS, marker);
    if (marker == EOI) return true;
    const size_t length = number_at(jpeg, at, 2);
    if (length < 2) return true;  // which the decoder refuses
    if (marker == DHT && !codes_fit(jpeg, at + 2, at + length)) return false;
    at += length;
  }
  return true;
}

bool png_chunks_fit(EncodedPicture png) {
  constexpr size_t signature = 8, around = 12;  // length, name and checksum
  for (size_t at = signature; at + around <= png.size();) {
    const size_t length = number_at(png, at, 4);
    if (length > png.size() - at - around) return false;
    at += around + length;
  }
  return true;
}

bool pixels_fit(std::int64_t pixels, size_t bytes) {
  constexpr std::int64_t always = std::int64_t(1) << 24, of_a_byte = 16384;
  return pixels <= always || pixels / of_a_byte <= std::int64_t(bytes);
}

}  // namespace volgi
