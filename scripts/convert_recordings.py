#!/usr/bin/env python3
"""Converts real recordings that public repositories hold into folders that FuseBench opens.

Usage: scripts/convert_recordings.py realsense-desk CLONE OUT
       scripts/convert_recordings.py iphone FOLDER OUT

realsense-desk  github.com/tronphan/3D-Rendering, commit dee2dd42: RealSense D435 colour and depth, T265 poses as ground truth, 2480
                frames. CLONE is its working tree; the recording is in "T265 Registration/dataset/realsense". OUT becomes a folder of
                TUM's layout.
iphone          a folder of the Stray Scanner app without its colour video, such as demo1_dataset of
                github.com/AroraMehul/QHack-EyeQ: LiDAR depth, IMU and ARKit's poses. OUT becomes the same layout with one uniform grey
                colour image, so that only depth and IMU carry information.

The recordings keep their own licences. Files are linked where OUT is on the same file system, and copied otherwise.
Exit codes: 0 converted; 2 usage, or OUT exists; 3 a file is missing or has other content than expected.
"""

import argparse
import csv
import os
import pathlib
import shutil
import struct
import sys
import zlib

FRAME_RATE_HZ = 30  # of the desk, whose stamps are lost
FIRST_STAMP_S = 1000

DESK_CALIBRATION = """\
calibration_source = "camera_intrinsic.json of the recording (D435, colour)"
[color]
width_px = 640
height_px = 480
fx_px = 615.2316284
fy_px = 615.4565430
cx_px = 321.2477112
cy_px = 244.2467651
distortion = [0, 0, 0, 0, 0]
[depth]
units_per_metre = 1000
"""

# T_imu_color was measured on demo1_dataset, to 6 mm; the noise densities are a guess (those of a ZR300).
IPHONE_IMU = """\
[imu]
T_imu_color = [0, -1, 0, 0.031,  -1, 0, 0, -0.003,  0, 0, -1, 0.004]
gyroscope_noise_radps_sqrthz = 1.1e-3
accelerometer_noise_mps2_sqrthz = 2.4e-2
gyroscope_bias_walk_radps2_sqrthz = 5e-5
accelerometer_bias_walk_mps3_sqrthz = 6.3e-4
"""
IPHONE_SIZE = (256, 192)
IPHONE_VIDEO_WIDTH = 1920  # that camera_matrix.csv is for


def link_or_copy(source, target):
    try:
        os.link(source, target)
    except OSError:
        shutil.copyfile(source, target)


def quaternion_product(a, b):
    """Hamilton product of quaternions (x, y, z, w)."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def desk_pose(row):
    """TUM line of T_world_camera. librealsense's T265 frame has x right, y up, z backwards; the camera has x right, y down,
    z forwards, and z of the world is up. The offset between the two cameras is unknown and taken as zero."""
    x, y, z = (float(row[f"Pos {axis}"]) for axis in "xyz")
    q_t265 = tuple(float(row[f"Rot {axis}"]) for axis in "xyzw")
    half = 0.5**0.5
    q_world_camera = quaternion_product((half, 0, 0, half), quaternion_product(q_t265, (1, 0, 0, 0)))
    stamp_s = FIRST_STAMP_S + int(row["Frame count"]) / FRAME_RATE_HZ
    return f"{stamp_s:.6f} {x:.6f} {-z:.6f} {y:.6f} " + " ".join(f"{c:.7f}" for c in q_world_camera) + "\n"


def convert_desk(clone, out):
    source = clone / "T265 Registration" / "dataset" / "realsense"
    for kind, folder in (("color", "rgb"), ("depth", "depth")):
        (out / folder).mkdir(parents=True, exist_ok=True)
        lines = [f"# stamps are lost: frame k at {FIRST_STAMP_S} s + k / {FRAME_RATE_HZ} s\n"]
        for image in sorted((source / kind).iterdir()):
            stamp_s = FIRST_STAMP_S + int(image.stem) / FRAME_RATE_HZ
            lines.append(f"{stamp_s:.6f} {folder}/{image.name}\n")
            link_or_copy(image, out / folder / image.name)
        (out / f"{folder}.txt").write_text("".join(lines))
    with open(source / "camera_pose.csv", newline="") as file:
        poses = [desk_pose(row) for row in csv.DictReader(file)]
    header = "# T265, whose clock is not the camera's; axes of the colour camera, z of the world up\n"
    (out / "groundtruth.txt").write_text(header + "# timestamp tx ty tz qx qy qz qw\n" + "".join(poses))
    (out / "calibration.toml").write_text(DESK_CALIBRATION)


def uniform_png(width, height, bits=8, channels=3, level=0):
    """An image of one level: bytes of a PNG, grey or RGB; with 16 bits, both bytes of a value are the level."""

    def chunk(kind, content):
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))

    rows = (b"\0" + bytes([level]) * (width * channels * bits // 8)) * height
    color_type = {1: 0, 3: 2}[channels]
    header = struct.pack(">IIBBBBB", width, height, bits, color_type, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b"")


def iphone_calibration(folder):
    """camera_matrix.csv scaled from the video to the depth images."""
    matrix = [[float(cell) for cell in line.split(",")] for line in (folder / "camera_matrix.csv").read_text().split("\n") if line]
    scale = IPHONE_SIZE[0] / IPHONE_VIDEO_WIDTH
    return (
        'calibration_source = "camera_matrix.csv of the app, scaled to the depth images; IMU axes measured, IMU noise guessed"\n'
        f"[color]\nwidth_px = {IPHONE_SIZE[0]}\nheight_px = {IPHONE_SIZE[1]}\n"
        f"fx_px = {matrix[0][0] * scale:.6f}\nfy_px = {matrix[1][1] * scale:.6f}\n"
        f"cx_px = {(matrix[0][2] + 0.5) * scale - 0.5:.6f}\ncy_px = {(matrix[1][2] + 0.5) * scale - 0.5:.6f}\n"
        "distortion = [0, 0, 0, 0, 0]\n[depth]\nunits_per_metre = 1000\n" + IPHONE_IMU
    )


def convert_iphone(folder, out):
    for name in ("depth", "confidence", "rgb"):
        (out / name).mkdir(parents=True, exist_ok=True)
    for name in ("imu.csv", "odometry.csv", "camera_matrix.csv"):
        link_or_copy(folder / name, out / name)
    depth = sorted((folder / "depth").iterdir())
    first = out / "rgb" / depth[0].name
    first.write_bytes(uniform_png(*IPHONE_SIZE, level=128))
    for image in depth:
        link_or_copy(image, out / "depth" / image.name)
        link_or_copy(folder / "confidence" / image.name, out / "confidence" / image.name)
        if image.name != first.name:
            link_or_copy(first, out / "rgb" / image.name)
    (out / "calibration.toml").write_text(iphone_calibration(folder))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter, usage=argparse.SUPPRESS)
    parser.add_argument("kind", choices=["realsense-desk", "iphone"])
    parser.add_argument("source", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    arguments = parser.parse_args()
    convert = {"realsense-desk": convert_desk, "iphone": convert_iphone}[arguments.kind]
    if arguments.out.exists():
        print(f"convert_recordings: {arguments.out} exists; remove it or give another folder", file=sys.stderr)
        return 2
    unfinished = arguments.out.with_name(f".{arguments.out.name}.tmp")
    shutil.rmtree(unfinished, ignore_errors=True)
    try:
        convert(arguments.source, unfinished)
        unfinished.rename(arguments.out)
    except (OSError, KeyError, ValueError, IndexError) as error:
        shutil.rmtree(unfinished, ignore_errors=True)
        print(f"convert_recordings: {arguments.source}: {error}", file=sys.stderr)
        return 3
    return 0


if __name__ == "__main__":
    sys.exit(main())
