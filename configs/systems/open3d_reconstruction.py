#!/usr/bin/env python3
"""Open3D's reconstruction system over an export of the format open3d: open3d_reconstruction.py EXPORT THREADS.

Works in the current folder. Leaves scene/trajectory.log and scene/integrated.ply there. The system is the one that
Debian's package python3-open3d ships as an example (Choi, Zhou & Koltun 2015), with its own settings.
"""
import json
import os
import runpy
import sys

if len(sys.argv) != 3:
    sys.exit(__doc__)
export, threads = os.path.abspath(sys.argv[1]), sys.argv[2]
for library in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ[library] = threads  # read when the library is loaded
# With OpenCV's Python module, this version of the system ends with an error of array shapes (opencv_pose_estimation.py);
# without it, it goes on without feature matches within a fragment.
sys.modules["cv2"] = None
import open3d  # noqa: E402

system = os.path.join(os.path.dirname(open3d.__file__), "examples", "reconstruction_system")
if not os.path.isfile(os.path.join(system, "run_system.py")):
    sys.exit(f"{system}: this build of Open3D comes without its reconstruction system")
for folder in ("color", "depth"):
    os.symlink(os.path.join(export, folder), folder)
with open(os.path.join(export, "config.json"), encoding="utf-8") as file:
    config = json.load(file)
config["path_dataset"] = os.getcwd()
config["path_intrinsic"] = os.path.join(export, "intrinsic.json")
config["python_multi_threading"] = False
with open("config.json", "w", encoding="utf-8") as file:
    json.dump(config, file)
sys.path.insert(0, system)
sys.argv = ["run_system.py", "--config", "config.json", "--make", "--register", "--refine", "--integrate"]
runpy.run_path(os.path.join(system, "run_system.py"), run_name="__main__")
