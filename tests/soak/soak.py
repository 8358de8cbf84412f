#!/usr/bin/env python3
"""Runs many tiny runs in one engine, or one long recording in one run, and watches memory, descriptors and time.

Usage: tests/soak/soak.py BINARY runs [--count N] [-j N] [--csv FILE]
       tests/soak/soak.py BINARY recording [--minutes N] [--size WxH] [--csv FILE]

runs: a sweep of N (default 1000) over a recording of 64x48 pixels and 3 frames, in one `bench`. recording: N (default 5) minutes at
10 Hz, simulated, in one `run`; at 320x240 pixels (default) it is tracked all along.
FILE (default build/soak/KIND.csv) gets a row a sample: seconds, runs or frames finished, resident kB, descriptors, children,
processor seconds. Compares the second eighth with the last one. Exit code: 0 nothing grows, 1 something does, 2 usage.
"""

import argparse
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import threading
import time

SUITE = """name = "soak"
variants = ["no-imu"]
keep = "small"
[config]
iekf.min_patches = 1
[[simulations]]
name = "tiny"
format = "tum"
preset = "slow"
start = "motion"
seed = 1
duration_s = 0.1
size = "64x48"
blur_samples = 1
[[sweep]]
design = "random"
samples = {count}
tsdf.voxel_m = {{ from = 0.01, to = 0.02 }}
"""


def sample(process):
    """(resident kB, descriptors, children, processor seconds) of a process, or None once it has ended."""
    try:
        status = pathlib.Path(f"/proc/{process}/status").read_text()
        resident = re.search(r"VmRSS:\s+(\d+)", status)
        children = pathlib.Path(f"/proc/{process}/task/{process}/children").read_text().split()
        times = pathlib.Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()
        cpu_s = (int(times[11]) + int(times[12])) / os.sysconf("SC_CLK_TCK")  # its own, without its children's
        return int(resident.group(1)), len(os.listdir(f"/proc/{process}/fd")), len(children), cpu_s
    except (OSError, AttributeError):
        return None


class Watch:
    """Starts a command and takes samples until it ends."""

    def __init__(self, command, progress):
        self.process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.done, self.rows, self.errors, self.output = 0, [], [], ""
        self.progress = progress
        readers = [threading.Thread(target=self.read_errors), threading.Thread(target=self.read_output)]
        for reader in readers:
            reader.start()
        begun = time.monotonic()
        while self.process.poll() is None:
            values = sample(self.process.pid)
            if values:
                self.rows.append((time.monotonic() - begun, self.progress(self), *values))
            time.sleep(0.25)
        self.took_s = time.monotonic() - begun
        for reader in readers:
            reader.join()

    def read_errors(self):
        for line in self.process.stderr:
            match = re.match(r"\[(\d+)/\d+\]", line)
            if match:
                self.done = int(match.group(1))
            else:
                self.errors.append(line)

    def read_output(self):
        self.output = self.process.stdout.read()

    def write(self, file):
        file = pathlib.Path(file)
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text("seconds,finished,resident_kb,descriptors,children,cpu_s\n" +
                        "".join(f"{row[0]:.2f}," + ",".join(map(str, row[1:])) + "\n" for row in self.rows))


def eighth(rows, number):
    return rows[len(rows) * number // 8:len(rows) * (number + 1) // 8]


def median(rows, column):
    return sorted(row[column] for row in rows)[len(rows) // 2]


def mean(rows, column):
    return sum(row[column] for row in rows) / max(len(rows), 1)


def judge(watch, what, allowed_kb_each):
    """Prints what changed from the second eighth to the last one; whether it is little."""
    early, late = eighth(watch.rows, 1), eighth(watch.rows, 7)
    if len(early) < 4 or len(late) < 4:
        print("soak: too short for a comparison; ask for more")
        return False
    finished = mean(late, 1) - mean(early, 1)
    memory_kb = mean(late, 2) - mean(early, 2)
    descriptors = median(late, 3) - median(early, 3)
    print(f"memory: {mean(early, 2) / 1024:.1f} MB in the second eighth, {mean(late, 2) / 1024:.1f} MB in the last: "
          f"{1024 * memory_kb / max(finished, 1):.0f} bytes for each {what}")
    print(f"descriptors: {median(early, 3)}, then {median(late, 3)} (medians; at most {max(row[3] for row in watch.rows)})")

    def speed(rows):
        return (rows[-1][0] - rows[0][0]) / max(rows[-1][1] - rows[0][1], 1)
    print(f"time for each {what}: {1000 * speed(early):.1f} ms, then {1000 * speed(late):.1f} ms")
    return memory_kb <= 1024 + allowed_kb_each * finished and descriptors <= 0


def overhead(folder):
    """Mean wall seconds of the runs themselves, by their records."""
    times = []
    for record in pathlib.Path(folder).rglob("record.json"):
        times.append(json.loads(record.read_text())["timing"]["wall_s"])
    return sum(times) / len(times) if times else 0.0


def many_runs(options, folder):
    suite = pathlib.Path(folder) / "soak.toml"
    suite.write_text(SUITE.format(count=options.count))
    command = [options.binary, "bench", str(suite), "--simulated", f"{folder}/simulated", "--out", f"{folder}/out", "-j",
               str(options.jobs), "--threads", "1"]
    watch = Watch(command, lambda self: self.done)
    watch.write(options.csv or "build/soak/runs.csv")
    print(f"{options.count} runs at {options.jobs} a time in {watch.took_s:.0f} s, exit code {watch.process.returncode}: "
          f"{1000 * watch.took_s / options.count:.1f} ms a run")
    inside = overhead(f"{folder}/out")
    print(f"of which {1000 * inside:.1f} ms are the run's own (timing.wall_s of its record)"
          + (f", and {1000 * (watch.took_s / options.count - inside):.1f} ms the engine's" if options.jobs == 1 else ""))
    print(f"processor time of the engine itself: {1000 * watch.rows[-1][5] / options.count:.1f} ms a run")
    left = [str(path) for path in pathlib.Path(folder, "out").rglob(".*.tmp")]
    if watch.process.returncode not in (0, 4) or left:
        print(f"soak: exit code {watch.process.returncode}, left {left[:3]}: {''.join(watch.errors[-3:])}")
        return False
    return judge(watch, "run", allowed_kb_each=4)


def long_recording(options, folder):
    recording = f"{folder}/long"
    subprocess.run([options.binary, "simulate", "--preset", "slow", "--format", "zr300", "--size", options.size, "--rate", "10", "--duration",
                    str(60 * options.minutes), "--blur-samples", "1", "--in-motion", "--out", recording], check=True)
    frames = 60 * options.minutes * 10
    hidden = pathlib.Path(folder) / "out"

    def progress(self):
        # Frames by the share of processor time: a run says nothing on the way.
        return 0 if not self.rows else self.rows[-1][1]
    watch = Watch([options.binary, "run", recording, "--variant", "full", "--set", "iekf.min_patches=2", "--threads", "1", "--out", str(hidden)], progress)
    watch.rows = [(row[0], round(frames * row[0] / watch.took_s), *row[2:]) for row in watch.rows]
    watch.write(options.csv or "build/soak/recording.csv")
    print(f"{frames} frames of {options.minutes} minutes in {watch.took_s:.0f} s, exit code {watch.process.returncode}: "
          f"{''.join(watch.errors[-1:]).strip()}")
    # Every frame is a row of states, frames and patches in memory until the end.
    return watch.process.returncode == 0 and judge(watch, "frame", allowed_kb_each=16)


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("\n\n")[1], add_help=False)
    parser.add_argument("binary")
    parser.add_argument("kind", choices=["runs", "recording"])
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--minutes", type=int, default=5)
    parser.add_argument("--size", default="320x240")
    parser.add_argument("-j", "--jobs", type=int, default=1)
    parser.add_argument("--csv")
    options = parser.parse_args()
    options.binary = os.path.realpath(options.binary)
    with tempfile.TemporaryDirectory(prefix="fusebench_soak_") as folder:
        flat = many_runs(options, folder) if options.kind == "runs" else long_recording(options, folder)
    print("soak: nothing grows" if flat else "soak: FAILED")
    return 0 if flat else 1


if __name__ == "__main__":
    sys.exit(main())
