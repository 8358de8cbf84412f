"""intensity.bin: how much each pixel of tracked patches differed, frame by frame (docs/files.md)."""

import array
import struct
import sys
from typing import NamedTuple

_MAGIC = b"FBINTENS"


class IntensityError(ValueError):
    """The file is no intensity.bin, or is damaged."""


class IntensityFrame(NamedTuple):
    """One frame; the three lists have one entry a pixel."""

    timestamp_ns: int
    pixel: list  #: v * width + u of the pixel of this frame where it lands
    difference_grey: list  #: absolute, grey levels
    accepted: list  #: whether its patch passed the gate

    def mean_grey(self):
        """The frame's intensity error: the AIE is the mean of these over frames that have pixels."""
        return sum(self.difference_grey) / len(self.pixel)


class _Reader:
    def __init__(self, file):
        self.file = file
        with open(file, "rb") as stream:
            self.data = stream.read()
        self.at = 0

    def wrong(self, what):
        return IntensityError(f"{self.file}: {what}; repeat the run that wrote it")

    def take(self, layout, what):
        size = struct.calcsize(layout)
        if self.at + size > len(self.data):
            raise self.wrong(f"ends early, {what}")
        values = struct.unpack_from(layout, self.data, self.at)
        self.at += size
        return values

    def take_list(self, code, count, what):
        values = array.array(code)
        size = count * values.itemsize
        if self.at + size > len(self.data):
            raise self.wrong(f"ends early, {what}")
        values.frombytes(self.data[self.at:self.at + size])
        if sys.byteorder == "big":
            values.byteswap()
        self.at += size
        return values


def read_intensity(file):
    """((width_px, height_px), [IntensityFrame]). Raises IntensityError for a file that is damaged."""
    reader = _Reader(file)
    if reader.data[:8] != _MAGIC:
        raise reader.wrong("is not a file of intensity differences")
    reader.at = 8
    version, width, height = reader.take("<III", "in its header")
    if version != 2:
        raise reader.wrong(f"has version {version} (this module reads 2)")
    frames = []
    while True:
        where = f"after frame {len(frames)}"
        (mark,) = reader.take("<I", where)
        if mark == 0:
            break
        if mark != 1:
            raise reader.wrong(f"is damaged {where}")
        stamp, count = reader.take("<qI", where)
        pixels = reader.take_list("I", count, where)
        differences = reader.take_list("f", count, where)
        if any(pixel >= width * height for pixel in pixels):
            raise reader.wrong(f"has a pixel outside the image {where}")
        # The sign bit says that the gate refused the patch, also where the difference is zero.
        signs = [bits >> 31 for bits in array.array("I", differences.tobytes())]
        frames.append(IntensityFrame(stamp, list(pixels), [abs(value) for value in differences], [s == 0 for s in signs]))
    (count,) = reader.take("<Q", "at its end mark")
    if count != len(frames) or reader.at != len(reader.data):
        raise reader.wrong("its end mark does not fit its frames")
    return (width, height), frames
