#!/usr/bin/env python3
"""Makes a damaged copy of a recording in TUM's layout: images are linked, lists are rewritten.

Usage: tests/support/damage_recording.py KIND RECORDING OUT [FRAME[:COUNT] ...]

KIND
  covered    the lens is covered: black colour, no depth
  colour     colour alone is missing: black colour
  depth      depth alone is missing: no depth
  gap        frames are missing altogether
FRAME:COUNT  first colour image of a stretch and its number of images; default: stretches that are spread evenly:
             covered, colour, depth: four of 1 s; gap: ten of 0.2 s
Black images have the size of the first image of the recording.
"""

import os
import pathlib
import struct
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
sys.dont_write_bytecode = True
from convert_recordings import uniform_png  # noqa: E402


def png_size(path):
    content = path.read_bytes()[:24]
    if content[:4] != b"\x89PNG":
        raise SystemExit(f"{path}: no PNG")
    return struct.unpack(">II", content[16:24])


def rows_of(path):
    """(stamp, file) of a list of TUM's."""
    rows = []
    for line in path.read_text().splitlines():
        words = line.split()
        if words and not words[0].startswith("#"):
            rows.append((words[0], words[1]))
    return rows


def stretches_of(kind, arguments, stamps):
    """[(first stamp, last stamp)] in seconds."""
    if arguments:
        firsts = [(int(a.split(":")[0]), int(a.split(":")[1]) if ":" in a else 30) for a in arguments]
        return [(stamps[first], stamps[min(first + count, len(stamps)) - 1]) for first, count in firsts]
    count, duration_s = {"gap": (10, 0.2)}.get(kind, (4, 1.0))
    begin, span = stamps[0], stamps[-1] - stamps[0]
    return [(begin + span * (k + 1) / (count + 1), begin + span * (k + 1) / (count + 1) + duration_s) for k in range(count)]


def main():
    if len(sys.argv) < 4 or sys.argv[1] not in ("covered", "colour", "depth", "gap"):
        raise SystemExit(__doc__)
    kind, source, out = sys.argv[1], pathlib.Path(sys.argv[2]).resolve(), pathlib.Path(sys.argv[3])
    out.mkdir(parents=True)
    for entry in source.iterdir():
        if entry.name not in ("rgb.txt", "depth.txt"):
            os.symlink(entry, out / entry.name)
    lists = {name: rows_of(source / f"{name}.txt") for name in ("rgb", "depth")}
    stretches = stretches_of(kind, sys.argv[4:], [float(stamp) for stamp, _ in lists["rgb"]])
    width, height = png_size(source / lists["depth"][0][1])
    (out / "no_colour.png").write_bytes(uniform_png(width, height))
    (out / "no_depth.png").write_bytes(uniform_png(width, height, bits=16, channels=1))
    half_frame_s = 0.015
    for name, black in (("rgb", "no_colour.png"), ("depth", "no_depth.png")):
        damaged = kind in ("covered", "gap") or kind == {"rgb": "colour", "depth": "depth"}[name]
        lines = ["# timestamp filename\n"]
        for stamp, file in lists[name]:
            inside = any(first - half_frame_s <= float(stamp) <= last + half_frame_s for first, last in stretches)
            if damaged and inside and kind == "gap":
                continue
            lines.append(f"{stamp} {black if damaged and inside else file}\n")
        (out / f"{name}.txt").write_text("".join(lines))


main()
