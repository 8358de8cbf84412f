#!/usr/bin/env python3
"""Reads or writes results of evo with nothing but Python's own zipfile, as an independent reader and writer.

Usage: tests/cli/evo_archive.py check FILE.zip ERRORS KIND    KIND: tum or kitti, of the trajectories
       tests/cli/evo_archive.py write FILE.zip NAME FACTOR    a result of an estimate NAME, deflated

check ends with 1 and a sentence if the archive is not what evo v1.36.5 loads (load_res_file(), np.load(),
read_tum_trajectory_file() and read_kitti_poses_file()), or if the statistics are not those of its errors.
"""
import ast
import json
import math
import pathlib
import struct
import sys
import zipfile


def fail(sentence):
    sys.exit(f"evo_archive: {sentence}")


def read_array(content, name):
    """Shape and values of format 1.0 of '<f8'."""
    if content[:8] != b"\x93NUMPY\x01\x00":
        fail(f"{name} is no array of format 1.0")
    (length,) = struct.unpack("<H", content[8:10])
    if (10 + length) % 64 or content[9 + length : 10 + length] != b"\n":
        fail(f"the header of {name} does not end with a newline at a multiple of 64 bytes")
    header = ast.literal_eval(content[10 : 10 + length].decode("latin1"))
    if set(header) != {"descr", "fortran_order", "shape"} or header["descr"] != "<f8" or header["fortran_order"]:
        fail(f"the header of {name} is {header}")
    count = math.prod(header["shape"])
    return header["shape"], struct.unpack(f"<{count}d", content[10 + length :])


def check_trajectory(text, name, columns, poses):
    rows = [line.split(" ") for line in text.splitlines() if not line.startswith("#")]
    if len(rows) != poses or any(len(row) != columns or not all(map(math.isfinite, map(float, row))) for row in rows):
        fail(f"{name} has not {poses} rows of {columns} numbers")


def check(path, errors, kind):
    with zipfile.ZipFile(path) as archive:
        if archive.testzip():
            fail(f"{archive.testzip()} is damaged")
        content = {name: archive.read(name) for name in archive.namelist()}
    info, stats = json.loads(content["info.json"]), json.loads(content["stats.json"])
    if set(info) != {"title", "ref_name", "est_name", "label"}:
        fail(f"info.json has {sorted(info)}")
    arrays = {pathlib.PurePath(n).stem: read_array(c, n) for n, c in content.items() if n.endswith(".npy")}
    shape, values = arrays.pop("error_array")
    if shape != (errors,):
        fail(f"error_array has the shape {shape}")
    expected = {
        "rmse": math.sqrt(math.fsum(e * e for e in values) / errors),
        "mean": math.fsum(values) / errors,
        "min": min(values),
        "max": max(values),
        "sse": math.fsum(e * e for e in values),
    }
    for name, value in expected.items():
        if not math.isclose(stats[name], value, rel_tol=1e-12):
            fail(f"{name} is {stats[name]}, of the errors {value}")
    if set(stats) != set(expected) | {"median", "std"}:
        fail(f"stats.json has {sorted(stats)}")
    matrix = arrays.pop("alignment_transformation_sim3", None)
    if matrix and (matrix[0] != (4, 4) or matrix[1][12:] != (0, 0, 0, 1)):
        fail(f"the alignment is {matrix}")
    times = {"seconds_from_start", "timestamps", "distances_from_start", "distances"} if kind == "tum" else set()
    if set(arrays) != times or any(shape != (errors,) for shape, _ in arrays.values()):
        fail(f"there are the arrays {sorted(arrays)}")
    poses = errors + (1 if info["title"].startswith("RPE") else 0)
    trajectories = [name for name in content if name.endswith(f".{kind}")]
    if len(trajectories) != 2:
        fail(f"there are the trajectories {trajectories}")
    for name in trajectories:
        check_trajectory(content[name].decode(), name, 8 if kind == "tum" else 12, poses)


def write(path, name, factor):
    errors = [factor * e for e in (0.1, 0.3, 0.2)]

    def array(values):
        header = f"{{'descr': '<f8', 'fortran_order': False, 'shape': ({len(values)},), }}"
        header += " " * (63 - (10 + len(header)) % 64) + "\n"
        return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode() + struct.pack("<3d", *values)

    stats = {"rmse": 0.216 * factor, "mean": 0.2 * factor, "median": 0.2 * factor, "std": 0.0816 * factor}
    stats |= {"min": min(errors), "max": max(errors), "sse": sum(e * e for e in errors)}
    info = {"title": "APE w.r.t. translation part (m)\n(not aligned)", "ref_name": "gt.txt", "est_name": name, "label": "APE (m)"}
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("info.json", json.dumps(info))
        archive.writestr("stats.json", json.dumps(stats))
        archive.writestr("error_array.npy", array(errors))
        archive.writestr("seconds_from_start.npy", array([0.0, 1.0, 2.0]))


if __name__ == "__main__":
    if len(sys.argv) != 5 or sys.argv[1] not in ("check", "write"):
        sys.exit(__doc__)
    if sys.argv[1] == "check":
        check(sys.argv[2], int(sys.argv[3]), sys.argv[4])
    else:
        write(sys.argv[2], sys.argv[3], float(sys.argv[4]))
