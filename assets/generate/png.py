"""PNG pictures of 8 bits: gray, RGB or RGBA."""

import struct
import zlib

import numpy as np

SIGNATURE = b"\x89PNG\r\n\x1a\n"

COLOR_TYPES = {1: 0, 3: 2, 4: 6}
"""PNG's name for each number of channels."""


def srgb(linear):
    """The bytes that stand for linear light from 0 to 1 (IEC 61966-2-1)."""
    linear = np.clip(linear, 0, 1)
    return share(np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055))


def share(numbers):
    """The bytes that stand for numbers from 0 to 1."""
    return np.round(255 * np.clip(numbers, 0, 1)).astype(np.uint8)


def chunk(name, body):
    """A chunk with its length and checksum."""
    checksum = zlib.crc32(name + body)
    return struct.pack(">I", len(body)) + name + body + struct.pack(">I", checksum)


def write(path, pixels):
    """Write bytes of the shape (height, width, channels), from the top row down."""
    height, width, channels = pixels.shape
    header = struct.pack(">IIBBBBB", width, height, 8, COLOR_TYPES[channels], 0, 0, 0)
    # Each row less the one above it, which PNG calls filter 2.
    above = np.concatenate([np.zeros_like(pixels[:1]), pixels[:-1]])
    rows = (pixels - above).reshape(height, -1)
    rows = np.concatenate([np.full((height, 1), 2, np.uint8), rows], axis=1)
    body = chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows.tobytes(), 9))
    path.write_bytes(SIGNATURE + body + chunk(b"IEND", b""))


def read(path):
    """Read a picture that write() wrote."""
    data = path.read_bytes()
    if not data.startswith(SIGNATURE):
        raise ValueError(f"{path} is no PNG picture")
    width, height, _, color_type = struct.unpack(">IIBB", data[16:26])
    channels = {name: count for count, name in COLOR_TYPES.items()}[color_type]
    (length,) = struct.unpack(">I", data[33:37])
    rows = np.frombuffer(zlib.decompress(data[41 : 41 + length]), np.uint8).reshape(height, -1)
    return np.cumsum(rows[:, 1:], axis=0, dtype=np.uint8).reshape(height, width, channels)
