"""Small valid inputs of every kind: recordings of each format, trajectories, meshes, archives, folders of runs and TOML.

make(program, folder): folder/NAME/... for each NAME of the returned dictionary {name: [files, relative]}.
"""

import json
import math
import os
import pathlib
import shutil

import images

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
GOLDEN = REPOSITORY / "tests" / "golden"
NOISE = ("gyroscope_noise_radps_sqrthz = 1e-3\naccelerometer_noise_mps2_sqrthz = 1e-2\n"
         "gyroscope_bias_walk_radps2_sqrthz = 1e-5\naccelerometer_bias_walk_mps3_sqrthz = 1e-4\n")
CORNER_OBJ = "".join(f"v {p}\n" for p in ("0 0 0", "4 0 0", "4 3 0", "0 3 0", "0 0 2.5", "4 0 2.5", "0 3 2.5"))
CORNER_OBJ += "vn 0 0 1\nvt 0 0\nf 1/1/1 2/1/1 3/1/1 4/1/1\nf 1 2 6 5\nf 1//1 4//1 7//1 5//1\n"


def write(path, content):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content.encode() if isinstance(content, str) else content)


def pose(k, stamp):
    angle = 0.05 * k
    return (f"{stamp} {math.cos(angle):.6f} {math.sin(angle):.6f} {0.1 * angle:.6f} 0 0 {math.sin(angle / 2):.6f} "
            f"{math.cos(angle / 2):.6f}\n")


def small_scene():
    """The corner as an ASCII PLY."""
    corners = [line[2:] for line in CORNER_OBJ.splitlines() if line.startswith("v ")]
    faces = ["3 0 1 2", "3 0 2 3", "3 0 1 5", "3 0 5 4", "3 0 3 6", "3 0 6 4"]
    header = (f"ply\nformat ascii 1.0\nelement vertex {len(corners)}\nproperty float x\nproperty float y\nproperty float z\n"
              f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n")
    return header + "\n".join(corners + faces) + "\n"


def lists_of(folder, names, stamps, depth_units, size=(64, 48), color="rgb", depth="depth"):
    for k, stamp in enumerate(stamps):
        write(folder / color / f"{names[k]}.png", images.color_png(*size, k))
        write(folder / depth / f"{names[k]}.png", images.depth_png(*size, depth_units, k))
    write(folder / f"{color}.txt", "# stamp name\n" + "".join(f"{s} {color}/{n}.png\n" for s, n in zip(stamps, names)))
    write(folder / f"{depth}.txt", "".join(f"{s} {depth}/{n}.png\n" for s, n in zip(stamps, names)))


def bonn(folder):
    folder = folder / "rgbd_bonn_tiny"
    for k in range(2):
        write(folder / "rgb" / f"{k}.png", images.flat_png(640, 480, (9, 8, 7)))
        write(folder / "depth" / f"{k}.png", images.flat_png(640, 480, (10000,), 16))
    write(folder / "rgb.txt", "# color\n10.0 rgb/0.png\n10.03 rgb/1.png\n")
    write(folder / "depth.txt", "10.01 depth/0.png\n10.04 depth/1.png\n")
    write(folder / "groundtruth.txt", "9.9 0 0 0 0 0 0 1\n10.1 1 2 3 0 0 0.70710678 0.70710678\n")


def open_loris(folder):
    stamps = [f"100.{k}" for k in range(3)]
    lists_of(folder, [str(k) for k in range(3)], stamps, 1000, color="color", depth="aligned_depth")
    write(folder / "sensors.yaml",
          "%YAML:1.0\nd400_color_optical_frame:\n   sensor_type: camera\n   fps: 30\n   width: 64\n   height: 48\n"
          "   model: pinhole\n   intrinsics: !!opencv-matrix\n      rows: 1\n      cols: 4\n      dt: d\n"
          "      data: [ 50., 31.5,\n          51., 23.5 ]\n   distortion_model: radial-tangential\n"
          "   distortion_coefficients: !!opencv-matrix\n      rows: 1\n      cols: 4\n      data: [ 0., 0., 0., 0. ]\n")
    write(folder / "trans_matrix.yaml",
          "%YAML:1.0\ntrans_matrix:\n -\n   parent_frame: base_link\n   child_frame: laser\n   matrix: !!opencv-matrix\n"
          "      rows: 4\n      cols: 4\n      data: [ 1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0.25, 0, 0, 0, 1 ]\n -\n"
          "   parent_frame: d400_color_optical_frame\n   child_frame: laser\n   matrix: !!opencv-matrix\n"
          "      data: [ 0, -1, 0, 0, 0, 0, -1, 0, 1, 0, 0, 0, 0, 0, 0, 1 ]\n"
          " - { parent_frame: d400_color_optical_frame, child_frame: d400_gyroscope,\n"
          "     matrix: !!opencv-matrix { rows: 4, cols: 4, data: [1,0,0,0.125, 0,1,0,0, 0,0,1,0, 0,0,0,1] } }\n")
    write(folder / "groundtruth.txt", "#T\n99.9 0 0 0 0 0 0 1\n100.3 1 2 3 0 0 0 1\n")
    samples = "".join(f"{99.9 + 0.005 * i:.3f} 0.1 -9.8 0.2\n" for i in range(80))
    write(folder / "d400_gyroscope.txt", "# t x y z\n" + samples)
    write(folder / "d400_accelerometer.txt", samples)


def eth3d(folder):
    stamps = ["61.045406", "61.082306", "61.119206"]
    lists_of(folder, stamps, stamps, 5000)
    write(folder / "associated.txt", "".join(f"{s} rgb/{s}.png {s} depth/{s}.png\n" for s in stamps))
    write(folder / "calibration.txt", "50 51 31.5 23.5\n")
    write(folder / "groundtruth.txt", "# t\n" + "".join(pose(k, s) for k, s in enumerate(("61.04", "61.08", "61.12"))))
    write(folder / "calibration.toml", "[color]\nfx_px = 50\nfy_px = 51\ncx_px = 31.5\ncy_px = 23.5\n[imu]\n"
          "T_imu_color = [1, 0, 0, 0.1, 0, 1, 0, 0, 0, 0, 1, 0]\n" + NOISE)


def seven_scenes(folder):
    for k in range(2):
        write(folder / f"frame-{k:06}.color.png", images.flat_png(640, 480, (9, 8, 7)))
        write(folder / f"frame-{k:06}.depth.png", images.flat_png(640, 480, (2000,), 16))
        write(folder / f"frame-{k:06}.pose.txt", f"1 0 0 {0.1 * k}\n0 1 0 -0.25\n0 0 1 2\n0 0 0 1\n")


def stray(folder):
    odometry = "timestamp, frame, x, y, z, qx, qy, qz, qw, fx, fy, cx, cy, more, more\n"
    for k in range(3):
        write(folder / "rgb" / f"{k:06}.png", images.color_png(64, 48, k))
        write(folder / "depth" / f"{k:06}.png", images.depth_png(16, 12, 1000, k))
        write(folder / "confidence" / f"{k:06}.png", images.flat_png(16, 12, (2,)))
        odometry += f"{100 + k / 32}, {k:06}, {0.01 * k}, 0.5, 0, 0, 0, 0, 1.0, 1600, 1600, 960, 720, , \n"
    write(folder / "odometry.csv", odometry)
    write(folder / "camera_matrix.csv", "1600.0, 0.0, 959.5\n0.0, 1600.0, 719.5\n0.0, 0.0, 1.0")
    write(folder / "imu.csv", "timestamp, a_x, a_y, a_z, alpha_x, alpha_y, alpha_z\n" +
          "".join(f"{99.9 + 0.01 * i:.3f}, 0.0, 0.0, -1, 0.1, 0.2, 0.3\n" for i in range(30)))


def record3d(folder):
    for k, name in enumerate(("float", "half")):
        write(folder / "EXR_RGBD" / "depth" / f"{k}.exr", (GOLDEN / "record3d" / f"{name}.exr").read_bytes())
        write(folder / "EXR_RGBD" / "rgb" / f"{k}.png", images.color_png(8, 6, k))
    write(folder / "EXR_RGBD" / "metadata.json",
          json.dumps({"w": 8, "h": 6, "dw": 4, "dh": 3, "fps": 60, "K": [10, 0, 0, 0, 11, 0, 3.5, 2.5, 1],
                      "poses": [[0, 0, 0, 1, 0, 0, 0], [0, 0, 0, 1, 0.01, 0, 0]], "frameTimestamps": [10.5, 10.53]}))


def zr300_raw(folder):
    for k, stamp in enumerate((1000000000, 1033000000, 1066000000)):
        write(folder / "color" / f"{stamp}.png", images.color_png(64, 48, k))
        write(folder / "depth" / f"{stamp}.png", images.depth_png(64, 48, 1000, k))
    write(folder / "COLOR.txt", "t(ms) name\n" + "".join(f"{s} {s}.png\n" for s in (1000000000, 1033000000, 1066000000)))
    write(folder / "DEPTH.txt", "t(ms) name\n" + "".join(f"{s} {s}.png\n" for s in (1000000000, 1033000000, 1066000000)))
    write(folder / "GYRO.txt", "".join(f"{900000000 + 5000000 * i} 0.1 0 0.2\n" for i in range(60)))
    write(folder / "ACCEL.txt", "".join(f"{900000000 + 4000000 * i} 0.1 9.8 0.2\n" for i in range(75)))
    write(folder / "calibration.toml", "[color]\nfx_px = 50\nfy_px = 51\ncx_px = 31.5\ncy_px = 23.5\n[imu]\n"
          "T_imu_color = [1, 0, 0, 0.1, 0, 1, 0, 0, 0, 0, 1, 0]\n" + NOISE)


def trajectories(folder):
    rows = [pose(k, f"{1305031100 + 0.1 * k:.4f}") for k in range(30)]
    write(folder / "gt.txt", "# timestamp tx ty tz qx qy qz qw\n" + "".join(rows))
    write(folder / "est.txt", "".join(pose(k, f"{1305031100.004 + 0.1 * k:.4f}") for k in range(0, 29)))
    columns = [row.split() for row in rows]
    write(folder / "data.csv", "#timestamp [ns],x,y,z,qw,qx,qy,qz\n" + "".join(
        f"{1305031100000000000 + 100000000 * k},{c[1]},{c[2]},{c[3]},{c[7]},{c[4]},{c[5]},{c[6]}\n"
        for k, c in enumerate(columns)))
    kitti, log, covariances = "", "", "# t tx ty tz qx qy qz qw and upper triangles\n"
    for k, c in enumerate(columns):
        cosine, sine = math.cos(0.05 * k), math.sin(0.05 * k)
        matrix = [f"{cosine:.6f} {-sine:.6f} 0 {c[1]}", f"{sine:.6f} {cosine:.6f} 0 {c[2]}", f"0 0 1 {c[3]}"]
        kitti += " ".join(matrix) + "\n"
        log += f"{k} {k} {k + 1}\n" + "\n".join(matrix) + "\n0 0 0 1\n"
        covariances += " ".join(c) + " 1e-6 0 0 1e-6 0 1e-6 1e-4 0 0 1e-4 0 1e-4\n"
    write(folder / "kitti.txt", kitti)
    write(folder / "poses.log", log)
    write(folder / "openvins.txt", covariances)
    write(folder / "transform.txt", "1 0 0 0\n0 1 0 0\n0 0 1 -0.01\n0 0 0 1\n")
    write(folder / "rgb.txt", "".join(f"{1305031100 + 0.1 * k:.4f} rgb/{k}.png\n" for k in range(30)))


def meshes(folder):
    write(folder / "rec.obj", CORNER_OBJ)
    write(folder / "truth.obj", "mtllib truth.mtl\nusemtl wall\n" + CORNER_OBJ)
    write(folder / "truth.mtl", "newmtl wall\nKd 1 1 1\n")
    write(folder / "rec.ply", small_scene())
    shutil.copy(GOLDEN / "mesh" / "tilted_plane_edges_gt.ply", folder / "binary.ply")
    shutil.copy(GOLDEN / "mesh" / "tilted_plane_edges_rec.ply", folder / "truth.ply")
    for name, values in (("gt.txt", range(30)), ("est.txt", range(29))):
        write(folder / name, "".join(pose(k, f"{100 + 0.1 * k:.4f}") for k in values))
    write(folder / "transform.txt", "1 0 0 0\n0 1 0 0\n0 0 1 -0.01\n0 0 0 1\n")


SUITE = """name = "tiny"
recordings = ["tum"]
variants = ["no-imu", "dm-no-imu"]
imu = "auto"
frames = ["0:2", "1:"]
repetitions = 1
keep = "small"
[config]
iekf.min_patches = 1
tsdf.voxel_m = 0.02
[limits]
time_s = 60
stall_s = 30
memory_mb = 800
[[sweep]]
iekf.max_iterations = [1, 2]
tsdf.truncation_m = { from = 0.05, to = 0.1, steps = 2, scale = "log" }
[[sweep]]
design = "zip"
depth.max_m = [4.0, 6.0]
depth.min_m = [0.3, 0.4]
[[exclude]]
reason = "none"
iekf.max_iterations = 2
depth.max_m = 6.0
[[criteria]]
title = "error"
variant = "no-imu"
metric = "ate_rmse_m"
max = 0.5
"""
SIMULATIONS = """name = "made"
variants = ["no-imu"]
[[simulations]]
name = "tiny"
format = "tum"
preset = "slow"
start = "motion"
seed = 1
duration_s = 0.1
size = "32x24"
blur_samples = 1
split = "tuning"
group = "slow"
[[sweep]]
design = "latin-hypercube"
samples = 3
seed = 2
tsdf.voxel_m = { from = 0.01, to = 0.02 }
iekf.max_iterations = { from = 1, to = 8 }
"""
SYSTEM = """name = "copier"
sentence = "Copies its truth"
export = "tum"
command = ["cp", "{recording}/groundtruth.txt", "{output}/answer.txt"]
version = ["echo", "1"]
imu = "none"
deterministic = true
[limits]
time_s = 5
memory_mb = 500
[trajectory]
file = "answer.txt"
format = "tum"
online = false
"""


def texts(folder, program):
    """Suites, systems, configurations, gates and calibrations, with the recording tum beside them."""
    write(folder / "suite.toml", SUITE)
    write(folder / "made.toml", SIMULATIONS)
    write(folder / "system.toml", SYSTEM)
    write(folder / "options.toml", program("config", "--variant", "dm-no-imu", "--set", "tsdf.voxel_m=0.02"))
    write(folder / "few.toml", "[iekf]\nmax_iterations = 5\n[tsdf]\nvoxel_m = 0.02\n[terms]\nmotion_compensation = false\n")
    gates = (REPOSITORY / "configs" / "gates.toml").read_text()
    write(folder / "gates.toml", gates + '[metrics.ate_rmse_m]\nrelative = 1e-9\nabsolute = 1e-6\nbetter = "smaller"\n'
          '[[overrides]]\nrecordings = ["tum*"]\nvariants = ["full"]\nmetrics = ["wall_s"]\nfactor = 1.5\n')


def run_folders(folder, program, tum):
    """runs/ of a suite with a failed run and an import, other/ of the same again."""
    shutil.copytree(tum, folder / "tum")
    write(folder / "suite.toml", SUITE.split("[[sweep]]")[0].replace('"small"', '"all"'))
    write(folder / "gates.toml", (REPOSITORY / "configs" / "gates.toml").read_text())
    for name in ("runs", "other"):
        program("bench", "suite.toml", "--data", ".", "--out", name, "--threads", "1", cwd=folder, codes=(0, 4))
    program("run", "tum", "--variant", "full", "--threads", "1", "--out", "runs", "--profile", cwd=folder, codes=(0, 4))
    program("import", "Other", "tum/groundtruth.txt", "tum/scene.ply", "--recording", "tum", "--imu", "none", "--out", "runs",
            cwd=folder)


def exported(folder, program, tum, form):
    program("export", tum, "--format", form, "--out", folder / ("room.sens" if form == "sens" else "room"))


def simulated(folder, program, form):
    program("simulate", "--preset", "slow", "--format", form, "--size", "64x48", "--duration", "0.1", "--blur-samples", "1",
            "--in-motion", "--threads", "1", "--out", folder)
    write(folder / "scene.ply", small_scene())


def archives(folder, program):
    trajectories(folder)
    for name, relation in (("a", "trans_part"), ("b", "rot_part")):
        program("eval", "ate", "gt.txt", "est.txt", "-a", "-r", relation, "--save_results", f"{name}.zip", cwd=folder)
    for name in ("gt.txt", "est.txt", "data.csv", "kitti.txt", "poses.log", "openvins.txt", "transform.txt", "rgb.txt"):
        os.remove(folder / name)


def make(program, folder):
    """program(*arguments, cwd, codes) -> standard output."""
    folder = pathlib.Path(folder)
    for form in ("tum", "icl", "zr300"):
        folder.joinpath(form).mkdir(parents=True)
        simulated(folder / form / form, program, form)
    tum = folder / "tum" / "tum"
    for name, maker in (("bonn", bonn), ("openloris", open_loris), ("eth3d", eth3d), ("7scenes", seven_scenes),
                        ("stray", stray), ("record3d", record3d), ("zr300_raw", zr300_raw)):
        maker(folder / name / name)
    for form in ("sens", "euroc", "open3d"):
        folder.joinpath(form).mkdir()
        exported(folder / form, program, tum, form)
    for bag in ("aligned_bz2", "aligned_lz4", "apart_none"):
        write(folder / bag / "room.bag", (GOLDEN / "rosbag" / f"{bag}.bag").read_bytes())
    trajectories(folder / "trajectories")
    meshes(folder / "meshes")
    (folder / "archives").mkdir()
    archives(folder / "archives", program)
    texts(folder / "texts", program)
    shutil.copytree(tum, folder / "texts" / "tum")
    (folder / "runs").mkdir()
    run_folders(folder / "runs", program, tum)
    return {base.name: sorted(str(file.relative_to(base)) for file in base.rglob("*") if file.is_file())
            for base in sorted(folder.iterdir())}
