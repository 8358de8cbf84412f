"""Which commands read which inputs: a case is a base of seeds, changes of its files, and the arguments of the program.

RECORDING, RUNS and so on are the kinds of inputs; each has its bases, and commands whose arguments are drawn.
"""

import re

import mutate

RECORDINGS = ("tum", "icl", "zr300", "zr300_raw", "bonn", "openloris", "eth3d", "7scenes", "stray", "record3d", "sens", "euroc", "open3d",
              "aligned_bz2", "aligned_lz4", "apart_none")
PLACES = {"bonn": "bonn/rgbd_bonn_tiny", "7scenes": "7scenes", "sens": "room.sens", "euroc": "room", "open3d": "room",
          "aligned_bz2": "room.bag", "aligned_lz4": "room.bag", "apart_none": "room.bag"}
LARGE = ("bonn", "7scenes")  # of 640x480 pixels, as their readers ask for
# A model may take 4 kB a block, whatever camera is told.
SHORT_RUN = ["--threads", "1", "--set", "iekf.min_patches=1", "--set", "tsdf.max_blocks=50000"]
PROTOCOLS = ("evo", "tum", "rpg", "eth3d", "kitti")
ALIGN = ("none", "se3", "sim3", "scale", "yaw", "origin")


def place_of(base):
    return PLACES.get(base, base)


def recording_command(rng, base):
    place = place_of(base)
    verb = rng.choice(["inspect"] * 6 + ["convert"] * 4 + ["export"] * 3 + ["run"] * 3 + ["calibrate", "smooth", "aie", "list", "bench"])
    if base in LARGE and verb in ("run", "calibrate", "smooth", "aie", "bench"):
        verb = "inspect"
    if verb == "inspect":
        return ["inspect", place, "--threads", "1"] + rng.choice([[], ["--json"], ["--page", "out.html"]])
    if verb == "convert":
        return ["convert", place, "--out", "out"] + rng.choice([[], ["--json"], ["--frames", "0:2"]])
    if verb == "export":
        return ["export", place, "--out", "out", "--format", rng.choice(["tum", "infinitam", "sens", "open3d", "euroc", "klg"])]
    if verb == "run":
        variant = rng.choice(["no-imu", "full", "dm-no-imu", "infinitam", "opencv-rgbd"])
        return ["run", place, "--variant", variant, "--imu", rng.choice(["auto", "auto", "recorded", "synthetic"]), "--out", "out",
                *SHORT_RUN] + rng.choice([[], ["--json"]])
    if verb in ("calibrate", "smooth"):
        return [verb, place, *SHORT_RUN, "--out", "out"]
    if verb == "aie":
        return ["eval", "aie", place, "--truth"] + rng.choice([[], ["--json"]])
    if verb == "bench":
        return ["bench", "suite_of_all.toml", "--data", ".", "--out", "out", "--threads", "1"]
    return ["list", "recordings", "--data", "."]


def trajectory_command(rng):
    estimate = rng.choice(["est.txt", "est.txt", "data.csv", "kitti.txt", "poses.log", "openvins.txt", "gt.txt"])
    truth = estimate if estimate in ("kitti.txt", "poses.log") else rng.choice(["gt.txt", "gt.txt", "data.csv"])
    verb = rng.choice(["ate", "ate", "rpe", "rpe", "traj", "nees", "silent", "import", "simulate"])
    more = rng.choice([[], ["--json"], ["--align", rng.choice(ALIGN)], ["-as"], ["--interpolate"], ["--protocol", rng.choice(PROTOCOLS)]])
    if verb == "ate":
        return ["eval", "ate", truth, estimate, *more] + rng.choice(
            [[], ["--errors", "out.csv"], ["--save_results", "out.zip"], ["--fit_offset"], ["--fit-time-offset"], ["--plot", "out.svg"],
             ["--protocol", "eth3d", "--images", "rgb.txt"]])
    if verb == "rpe":
        return ["eval", "rpe", truth, estimate, *more] + rng.choice(
            [[], ["--all_pairs"], ["--fit-time-offset"], ["-d", "1", "-u", rng.choice("fmdrs")], ["--errors", "out.csv"]])
    if verb == "traj":
        return ["eval", "traj", estimate, "--ref", truth] + rng.choice(
            [[], ["-f"], ["--save_as_tum"], ["--save_as_kitti"], ["--save_table", "out.csv"], ["--json"], ["--sync", "-a"], ["--fit-time-offset"]])
    if verb == "nees":
        return ["eval", "nees", "gt.txt", "openvins.txt"] + rng.choice([[], ["--json"], ["--errors", "out.csv"], ["--align", "yaw"]])
    if verb == "silent":
        return ["eval", "silent", "gt.txt", "est.txt"] + rng.choice([[], ["--json"]])
    if verb == "import":
        return ["import", "Other", estimate, "--recording", "tum", "--out", "out", "--threads", "1"]
    return ["simulate", "--trajectory", truth, "--format", "tum", "--size", "32x24", "--duration", "0.1", "--blur-samples", "1",
            "--threads", "1", "--out", "out"]


def mesh_command(rng):
    if rng.random() < 0.15:
        return ["simulate", "--scene", rng.choice(["truth.obj", "truth.ply", "rec.ply"]), "--format", "tum", "--size", "32x24",
                "--duration", "0.1", "--blur-samples", "1", "--threads", "1", "--out", "out"]
    rec, truth = rng.choice(["rec.obj", "rec.ply", "binary.ply"]), rng.choice(["truth.obj", "truth.ply"])
    more = rng.choice([[], ["--align", "icp"], ["--align", "file", "--transform", "transform.txt"], ["--colored", "out.ply"], ["--json"],
                       ["--align", "trajectory", "--trajectories", "gt.txt", "est.txt"], ["--samples", "vertices"]])
    samples = [] if "--samples" in more else ["--samples", "500"]
    return ["eval", "mesh", rec, truth, "--threads", "1", *samples, *more]


def text_command(rng, changed):
    if changed == "system.toml":
        return ["run", "tum", "--system", "system.toml", "--out", "out", "--threads", "1"]
    if changed in ("options.toml", "few.toml"):
        return rng.choice([["config", "--config", changed], ["config", "--config", changed, "--json"],
                           ["run", "tum", "--variant", "no-imu", "--config", changed, "--threads", "1", "--frames", "0:2", "--out", "out"]])
    suite = "made.toml" if changed == "made.toml" else "suite.toml"
    return ["bench", suite, "--data", ".", "--out", "out", "--threads", "1", "--simulated", "simulated"] + rng.choice(
        [["--dry-run"], ["--dry-run"], ["--dry-run", "--json"], [], ["--summary", "summary.json", "--summary-page", "summary.html"]])


def runs_command(rng):
    verb = rng.choice(["table", "table", "collect", "best", "compare", "report", "list", "gc", "merge", "rerun", "like", "bench", "task"])
    if verb == "table":
        return ["table", "runs"] + rng.choice([[], ["--format", rng.choice(["csv", "csv-long", "json", "latex"])], ["--systems"],
                                               ["--paper", "table1"]])
    if verb == "collect":
        return ["collect", "runs"] + rng.choice([[], ["--format", "jsonl"], ["--out", "out.csv"], ["--without-timing"]])
    if verb == "best":
        return ["best", "runs", "--by", rng.choice(["ate", "rpe", "aie", "cpu", "memory"])] + rng.choice(
            [[], ["--json"], ["--format", "csv"], ["--group", "none"]])
    if verb == "compare":
        form = rng.choice(["table", "markdown", "json", "junit", "gbench", "github-benchmark", "openmetrics"])
        return ["compare", "other", "runs", "--format", form] + rng.choice([[], ["--gates", "gates.toml"], ["--all"], ["--out", "out.txt"]])
    if verb == "report":
        return ["report", "runs", "--out", "out.html"]
    if verb == "list":
        return ["list", "runs", "runs"] + rng.choice([[], ["--verify"], ["--json"], ["-o", "failed"]])
    if verb == "gc":
        return ["gc", "runs"] + rng.choice([[], ["--failed"], ["--stale", "--dry-run"], ["--json"]])
    if verb == "merge":
        return ["merge", "runs", "other", "--into", "out"]
    if verb == "rerun":
        return ["rerun", "runs"]
    if verb == "like":
        return ["run", "--like", "runs/tum/no-imu/@", "--data", ".", "--out", "out", "--threads", "1"]
    if verb == "task":
        return ["slurm-task", "runs/.fusebench/invocations/@.json", "gates.toml", "0"]
    return ["bench", "suite.toml", "--data", ".", "--out", "runs", "--threads", "1"]


def archive_command(rng):
    return ["eval", "res", "a.zip", "b.zip", "--ignore_title"] + rng.choice([[], ["--json"], ["--merge"], ["--save_table", "out.csv"],
                                                                            ["--use_filenames"]])


def options_of(help_text):
    """Options that take a value, of a verb's help."""
    return sorted(set(re.findall(r"^ +(?:-\w,)?(--[\w-]+)(?:,--?[\w-]+)* (?=[A-Z])", help_text, re.M)))


def with_option(rng, arguments, helps):
    """One more option of the verb, with a value that is seldom right."""
    verb = tuple(arguments[:2]) if arguments[0] == "eval" else (arguments[0],)
    options = [o for o in helps.get(verb, []) if o not in arguments and o not in
               ("--out", "--threads", "--data", "--simulated", "--size", "--blur-samples", "--logfile", "--slurm-arg", "--executor",
                "--save_results", "--save_plot", "--plot", "--figures", "--colored", "--errors", "--page", "--save_table", "--summary",
                "--summary-page", "--configs")]
    if not options:
        return arguments
    value = rng.choice([mutate.some_token(rng), mutate.some_number(rng), "0:2", "1:", "a=b", "nan", "1,2,3,4", "1,1,1,1,0,0,0,0,0", "1e300",
                        "iekf.max_iterations=1,2,3", "tsdf.voxel_m=" + mutate.some_number(rng), "frame"])
    return [*arguments, f"{rng.choice(options)}={value}".replace("\0", "")]
