"""Radiance pictures (.hdr): three mantissas and a shared exponent, a byte each."""

import numpy as np


def encoded(pixels):
    """RGBE bytes of linear pixels: (height, width, 4)."""
    _, exponent = np.frexp(pixels.max(axis=2))
    mantissas = np.floor(np.ldexp(pixels, (8 - exponent)[:, :, None]))
    return np.concatenate([mantissas, (exponent + 128)[:, :, None]], axis=2).astype(np.uint8)


def decoded(rgbe):
    """Linear pixels of RGBE bytes."""
    return np.ldexp(rgbe[:, :, :3] + 0.5, rgbe[:, :, 3:].astype(int) - 136)


def write(path, pixels, title):
    """Write a picture without run lengths; the same pixels always give the same bytes."""
    height, width, _ = pixels.shape
    header = f"#?RADIANCE\n# {title}\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n"
    path.write_bytes(header.encode("ascii") + encoded(pixels).tobytes())


def read(path):
    """Read a picture that write() wrote."""
    header, _, body = path.read_bytes().partition(b"\n\n")
    size, _, rgbe = body.partition(b"\n")
    _, height, _, width = size.split()
    if not header.startswith(b"#?RADIANCE"):
        raise ValueError(f"{path} is no Radiance picture")
    return decoded(np.frombuffer(rgbe, np.uint8).reshape(int(height), int(width), 4))
