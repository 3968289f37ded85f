"""PNG files whose bytes depend on nothing but the pixels, and the colour encoding of glTF's textures."""
import struct
import zlib


def srgb8(linear):
    """Linear [0, 1] -> the 8-bit sRGB code that decodes nearest to it."""
    c = min(max(linear, 0.0), 1.0)
    encoded = 12.92 * c if c <= 0.0031308 else 1.055 * c ** (1 / 2.4) - 0.055
    return int(encoded * 255 + 0.5)


def linear_from_srgb8(code):
    c = code / 255
    return c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4


def _chunk(kind, data):
    return struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))


def _zlib_stored(data):
    """A zlib stream of uncompressed blocks: zlib versions differ in how they compress, and so would the bytes."""
    blocks = [data[i:i + 65535] for i in range(0, len(data), 65535)]
    out = b'\x78\x01'
    for i, block in enumerate(blocks):
        out += struct.pack('<BHH', i + 1 == len(blocks), len(block), 0xffff ^ len(block)) + block
    return out + struct.pack('>I', zlib.adler32(data))


def encode(width, height, pixel):
    """PNG of pixel(x, y) -> linear (r, g, b), row 0 at the top, 8-bit sRGB in a palette where 256 colours suffice."""
    codes = {}
    rows = [[tuple(srgb8(c) for c in pixel(x, y)) for x in range(width)] for y in range(height)]
    for row in rows:
        for rgb in row:
            codes.setdefault(rgb, len(codes))
    if len(codes) <= 256:
        colour_type, head = 3, _chunk(b'PLTE', b''.join(bytes(rgb) for rgb in codes))
        raw = b''.join(b'\0' + bytes(codes[rgb] for rgb in row) for row in rows)
    else:
        colour_type, head = 2, b''
        raw = b''.join(b'\0' + b''.join(bytes(rgb) for rgb in row) for row in rows)
    header = struct.pack('>IIBBBBB', width, height, 8, colour_type, 0, 0, 0)
    return (b'\x89PNG\r\n\x1a\n' + _chunk(b'IHDR', header) + head + _chunk(b'IDAT', _zlib_stored(raw)) +
            _chunk(b'IEND', b''))


def colours(data):
    """Linear colours that occur in a PNG written by encode()."""
    at, found, colour_type, raw, width = 8, [], 0, b'', 0
    while at < len(data):
        length, kind = struct.unpack_from('>I4s', data, at)
        body = data[at + 8:at + 8 + length]
        if kind == b'IHDR':
            width, colour_type = struct.unpack_from('>I', body)[0], body[9]
        elif kind == b'PLTE':
            found = [tuple(body[i:i + 3]) for i in range(0, length, 3)]
        elif kind == b'IDAT':
            raw += body
        at += 12 + length
    if colour_type == 2:
        raw, stride = zlib.decompress(raw), 1 + 3 * width
        found = sorted({tuple(raw[i:i + 3]) for row in range(0, len(raw), stride)
                        for i in range(row + 1, row + stride, 3)})
    return [tuple(linear_from_srgb8(c) for c in rgb) for rgb in found]
