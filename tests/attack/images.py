"""Tiny images and files of images, written byte by byte: seeds and mutations know where each field is."""

import struct
import zlib


def png_chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png(width, height, value, bits=8, channels=3):
    """value(x, y): the samples of a pixel, a tuple."""
    form = ">H" if bits == 16 else ">B"
    rows = bytearray()
    for y in range(height):
        rows.append(0)
        for x in range(width):
            for sample in value(x, y):
                rows += struct.pack(form, sample)
    header = struct.pack(">IIBBBBB", width, height, bits, 2 if channels == 3 else 0, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + png_chunk(b"IHDR", header) + png_chunk(b"IDAT", zlib.compress(bytes(rows), 1)) +
            png_chunk(b"IEND", b""))


def color_png(width, height, seed=0):
    return png(width, height, lambda x, y: ((7 * x + 13 * seed) % 256, (x * y + 5 * y) % 256, (11 * y) % 256))


def depth_png(width, height, units_per_metre=1000, seed=0):
    return png(width, height, lambda x, y: (int(units_per_metre * (2 + 0.2 * ((x + seed) % 7) / 7 + 0.01 * y)) % 65535,),
               bits=16, channels=1)


def flat_png(width, height, samples, bits=8):
    return png(width, height, lambda x, y: samples, bits=bits, channels=len(samples))


def png_chunks(data):
    """[(kind, data)], as far as they go."""
    at, chunks = 8, []
    while at + 12 <= len(data):
        size = struct.unpack(">I", data[at:at + 4])[0]
        chunks.append((data[at + 4:at + 8], data[at + 8:at + 8 + size]))
        at += 12 + size
    return chunks


def png_of(chunks):
    return b"\x89PNG\r\n\x1a\n" + b"".join(png_chunk(kind, data) for kind, data in chunks)
