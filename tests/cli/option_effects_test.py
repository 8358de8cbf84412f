#!/usr/bin/env python3
"""Every option of `fusebench eval ate|rpe|traj|nees|silent` changes a result, or is an error or a warning, with every protocol.

Usage: tests/cli/option_effects_test.py BINARY
"""
import json
import math
import os
import random
import re
import subprocess
import sys
import tempfile

PROTOCOLS = {"ate": ("evo", "tum", "rpg", "eth3d"), "rpe": ("evo", "tum", "rpg", "eth3d", "kitti")}
# Values that change the numbers of the trajectories below wherever the option is applied.
ARGUMENTS = {
    "--format": ["--format", "tum"],
    "--stamp_unit": ["--stamp_unit", "ms,s"],
    "--align": ["--align", "se3"],
    "-a": ["-a"],
    "--correct_scale": ["-s"],
    "--align_origin": ["--align_origin"],
    "--n_to_align": ["--n_to_align", "20"],
    "--t_max_diff": ["--t_max_diff", "0.003"],
    "--t_offset": ["--t_offset", "0.3"],
    "--t_start": ["--t_start", "1010"],
    "--t_end": ["--t_end", "1027"],
    "--interpolate": ["--interpolate"],
    "--images": ["--images", "rgb.txt"],
    "--duplicates": ["--duplicates", "first"],
    "--downsample": ["--downsample", "150"],
    "--motion_filter": ["--motion_filter", "0.7", "30"],
    "--project_to_plane": ["--project_to_plane", "xz"],
    "--pose_relation": ["-r", "full"],
    "--change_unit": ["--change_unit", "mm"],
    "--fit_offset": ["--fit_offset"],
    "--fit-time-offset": ["--fit-time-offset"],
    "--delta": ["-d", "3"],
    "--delta_unit": ["-d", "10", "-u", "m"],
    "--delta_tol": ["-t", "0.01"],
    "--all_pairs": ["--all_pairs"],
    "--pairs_from_reference": ["--pairs_from_reference"],
    "--plot_mode": ["--plot_mode", "xy"],
    "--plot_x_dimension": ["--plot_x_dimension", "distances"],
    "--plot_colormap_min": ["--plot_colormap_min", "0.01"],
    "--plot_colormap_max": ["--plot_colormap_max", "0.02"],
    "--plot_colormap_max_percentile": ["--plot_colormap_max_percentile", "50"],
    "--plot_full_ref": ["--plot_full_ref"],
    "--sync": ["--sync"],
    "--full_check": ["-f"],
    "--show_full_names": ["--show_full_names"],
    "--figure-format": ["--figure-format", "pdf"],
    "--interval": ["--interval", "0.5"],
    "--translation": ["--translation", "0.2"],
    "--rotation": ["--rotation", "1"],
    "--offset": ["--offset", "1", "0", "0"],
}
# The options that only say where results go, and those that other rows contain or need.
OUTPUTS = {"--help", "--protocol", "-p", "--plot", "--save_plot", "--save_results", "--errors", "--silent", "--logfile", "--json",
           "--all_errors", "--ref", "--save_table", "--save_as_tum", "--save_as_kitti", "--figures", "--verbose"}
# What repeats the request in a document, or differs without an effect on numbers.
REQUEST = {"association", "plane", "motions", "mode", "protocol", "first", "requested"}
# Pairs of a verb or protocol and an option that may change nothing: what is given is what is recognised or the default.
SAME = {("*", "--format"), ("*", "--plot_full_ref"), ("*", "--full_check"), ("rpe kitti", "--duplicates"), ("nees", "--align"),
        ("ate evo without stamps", "--plot_x_dimension"), ("rpe evo without stamps", "--plot_x_dimension"),
        ("traj ", "--stamp_unit"), ("traj --ref gt.txt", "--sync"), ("traj --ref gt.txt -a", "--sync"), ("rpe evo ", "--all_pairs"), ("rpe evo -s", "--all_pairs"),
        ("rpe evo without stamps ", "--all_pairs"), ("rpe evo without stamps -s", "--all_pairs"), ("ate tum", "--align"), ("ate tum", "-a"), ("ate eth3d", "--align"), ("ate eth3d", "-a"),
        ("rpe eth3d", "--align"), ("rpe eth3d", "-a")}
# Further contexts in which options are given: arguments that all runs of the context have.
CONTEXTS = {
    "ate": ([], ["--plot", "plot.svg"], ["-a"]),
    "rpe": ([], ["--plot", "plot.svg"], ["-s"], ["--all_pairs"], ["--all_pairs", "-u", "m", "-d", "5"], ["-d", "3"], ["-u", "m", "-d", "5"]),
    "traj": ([], ["--ref", "gt.txt"], ["--ref", "gt.txt", "-a"], ["--ref", "gt.txt", "--sync"], ["--plot", "plot.svg"]),
    "nees": ([], ["--figures", "figures"]),
    "silent": ([],),
}


def trajectory(noise, drawn):
    rows = []
    for i in range(300):
        t = 0.1 * i
        yaw, pitch = t / 3 + drawn.gauss(0, 0.02 * noise), 0.3 * math.sin(t) + drawn.gauss(0, 0.02 * noise)
        position = [value + drawn.gauss(0, 0.05 * noise)
                    for value in (5 * t, 8 * math.sin(t / 3), math.sin(t) + 0.4 * math.sin(5 * t))]
        cy, sy, cp, sp = math.cos(yaw / 2), math.sin(yaw / 2), math.cos(pitch / 2), math.sin(pitch / 2)
        stamp = 1000 + t + (0.005 * math.sin(i) if noise else 0)
        rows.append([stamp, *position, -sp * sy, sp * cy, cp * sy, cp * cy])
    return rows


def write(name, rows):
    with open(name, "w", encoding="utf-8") as file:
        for row in rows:
            file.write(" ".join(f"{value:.9f}" for value in row) + "\n")


def make_files():
    drawn = random.Random(1)
    reference, estimate = trajectory(0, drawn), trajectory(1, drawn)
    write("gt.txt", reference)
    repeated = estimate[:100] + [[estimate[99][0], *estimate[60][1:]]] + estimate[100:]
    write("est.txt", repeated[:-20])
    covariance = [4e-4, 0, 0, 4e-4, 0, 4e-4, 25e-4, 0, 0, 25e-4, 0, 25e-4]
    write("covariances.txt", [row + covariance for row in estimate])
    with open("rgb.txt", "w", encoding="utf-8") as file:
        for row in reference[:-1:3]:
            file.write(f"{row[0] + 0.03:.6f} rgb/x.png\n")
    for name, rows in (("gt.kitti", reference), ("est.kitti", estimate)):
        with open(name, "w", encoding="utf-8") as file:
            for row in rows:
                file.write(" ".join(f"{value:.9f}" for value in kitti_row(row)) + "\n")


def kitti_row(row):
    x, y, z, w = row[4:]
    rotation = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    return [value for k in range(3) for value in (*rotation[k], row[1 + k])]


def results(document):
    """A document without what only repeats the request."""
    if isinstance(document, dict):
        return {key: results(value) for key, value in document.items() if key not in REQUEST}
    if isinstance(document, list):
        return [results(value) for value in document]
    return document


class Verbs:
    def __init__(self, binary):
        self.binary = binary
        self.runs = 0

    def options(self, verb):
        """The options of a verb by their longest names, with their help texts."""
        text = subprocess.run([self.binary, "eval", verb, "--help"], check=True, capture_output=True, text=True).stdout
        found = {}
        for names, rest in re.findall(r"^  ((?:-{1,2}[\w-]+,?)+)((?:.*\n(?:    .*\n)*))", text, re.MULTILINE):
            longest = [name for name in names.split(",") if name.startswith("--")]
            found[longest[0] if longest else names] = rest
        return found

    def output(self, verb, arguments):
        """What a run writes, or None if the command line is refused or an option is said to have no effect."""
        self.runs += 1
        with tempfile.TemporaryDirectory(dir=".") as folder:
            for name in os.listdir("."):
                if os.path.isfile(name):
                    os.link(name, os.path.join(folder, name))
            done = subprocess.run([self.binary, "eval", verb, *arguments, "--json"], cwd=folder, capture_output=True, text=True)
            if done.returncode == 2 or " has no effect " in done.stderr:
                return None
            if done.returncode != 0:
                return ("error", done.stderr)
            files = {}
            for place, _, names in os.walk(folder):
                for name in names:
                    path = os.path.join(place, name)
                    if os.stat(path).st_nlink == 1 and name.endswith((".gnuplot", ".gp", ".svg", ".pdf")):
                        with open(path, "rb") as file:
                            files[os.path.relpath(path, folder)] = file.read()
            return (results(json.loads(done.stdout)), files)

    def cases(self):
        """Of each case its name, the verb, and the arguments of all its runs."""
        for verb in ("ate", "rpe"):
            for protocol in PROTOCOLS[verb]:
                yield f"{verb} {protocol}", verb, ["gt.txt", "est.txt", "--protocol", protocol, "--all_errors"]
                if protocol == "evo" or protocol == "kitti":
                    yield f"{verb} {protocol} without stamps", verb, ["gt.kitti", "est.kitti", "--protocol", protocol, "--all_errors"]
        yield "traj", "traj", ["est.txt"]
        yield "nees", "nees", ["gt.txt", "covariances.txt"]
        yield "silent", "silent", ["gt.txt", "est.txt"]


def ineffective(verbs):
    """Yields a sentence for each option that has no effect, and for each that this test does not have."""
    for name, verb, arguments in verbs.cases():
        options = verbs.options(verb)
        for option in sorted(set(options) - set(ARGUMENTS) - OUTPUTS):
            if "Accepted for compatibility" not in options[option]:
                yield f"{verb}: {option} has no row in this test"
        for context in CONTEXTS[verb]:
            usual = verbs.output(verb, arguments + context)
            drawn = {"--plot", "--figures"} & set(context)
            if usual is None:
                continue  # the context is refused
            for option in sorted(set(options) & set(ARGUMENTS)):
                if {(name, option), (f"{name} {' '.join(context)}", option), ("*", option)} & SAME or set(ARGUMENTS[option]) & set(context):
                    continue
                if drawn and not option.startswith(("--plot", "--figure")):
                    continue
                if verbs.output(verb, arguments + context + ARGUMENTS[option]) == usual:
                    yield f"{name} {' '.join(context)}: {' '.join(ARGUMENTS[option])} changes nothing"


def main():
    if len(sys.argv) != 2 or sys.argv[1] in ("-h", "--help"):
        print(__doc__.strip(), file=sys.stderr)
        return 2
    verbs = Verbs(os.path.abspath(sys.argv[1]))
    failures = 0
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        make_files()
        for failure in ineffective(verbs):
            failures += 1
            print("FAILED: " + failure, file=sys.stderr)
        os.chdir("/")
    print(f"option effects: {verbs.runs} runs, {failures} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
