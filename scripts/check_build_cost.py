#!/usr/bin/env python3
"""Compares what the compiler has to read of each target with the committed numbers: a gate of the cost of a build.

Usage: scripts/check_build_cost.py [--build FOLDER] [--update REASON]

Runs the preprocessor over every compilation of a built tree (default: build/ci) and sums up the bytes that it hands to the
compiler, by target, without those of the precompiled headers. The numbers depend on the sources and the libraries alone, not on
the machine. A target fails that has grown by more than 10 % and 300 kB, and the sum if it is more than 3 % off in either
direction.
  --update REASON  makes the numbers the committed ones, results/build_cost.csv, and adds the reason to
                   results/build_cost_history.md
Where compiler or distribution are not those of the committed numbers, changes are reported and fail nothing.
Exit code: 0 within the limits, 1 not, 2 usage or an incomplete build.
"""
import argparse
import concurrent.futures
import datetime
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
COMMITTED = ROOT / "results" / "build_cost.csv"
HISTORY = ROOT / "results" / "build_cost_history.md"
TARGET_GROWTH = 0.10
TARGET_GROWTH_BYTES = 300_000
SUM_CHANGE = 0.03


def compilations(build):
    """[(target, command without its output)] of the folder's compilations, but for precompiled headers."""
    for entry in json.loads((build / "compile_commands.json").read_text()):
        words = shlex.split(entry["command"])
        output = words[words.index("-o") + 1]
        if "cmake_pch" in entry["file"]:
            continue
        kept = [word for word in words if word not in ("-c", "-MD")]
        for flag in ("-o", "-MT", "-MF"):
            if flag in kept:
                at = kept.index(flag)
                del kept[at:at + 2]
        while kept and not re.search(r"(c\+\+|g\+\+|clang\+\+)(-\d+)?$", kept[0]):  # a launcher
            del kept[0]
        yield re.search(r"CMakeFiles/([^/]+)\.dir/", output).group(1), kept, entry["directory"]


def preprocessed_bytes(command, folder):
    """-P: without lines that name files, whose paths differ between checkouts."""
    result = subprocess.run([*command, "-E", "-P", "-fpch-preprocess"], cwd=folder, capture_output=True, check=False)
    if result.returncode != 0:
        sys.exit(f"check_build_cost: {command[-1]} is not preprocessed:\n{result.stderr.decode(errors='replace')[-2000:]}")
    return sum(len(line) + 1 for line in result.stdout.split(b"\n") if not line.startswith(b"#pragma GCC pch_preprocess"))


def environment(build):
    cache = (build / "CMakeCache.txt").read_text()
    compiler = re.search(r"^CMAKE_CXX_COMPILER:\w+=(.*)$", cache, re.MULTILINE).group(1)
    version = subprocess.run([compiler, "-dumpfullversion"], capture_output=True, text=True, check=True).stdout.strip()
    release = dict(re.findall(r'^(\w+)="?([^"\n]*)"?$', pathlib.Path("/etc/os-release").read_text(), re.MULTILINE))
    return f"g++ {version}, {release.get('PRETTY_NAME', 'unknown')}"


def measured(build):
    """{target: bytes}, by name."""
    commands = list(compilations(build))
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        sizes = pool.map(lambda item: preprocessed_bytes(item[1], item[2]), commands)
        targets = {}
        for (target, _, _), size in zip(commands, sizes):
            targets[target] = targets.get(target, 0) + size
    return dict(sorted(targets.items()))


def read_committed():
    if not COMMITTED.is_file():
        return "", {}
    lines = COMMITTED.read_text().splitlines()
    return lines[0].removeprefix("# "), {row.split(",")[0]: int(row.split(",")[1]) for row in lines[2:]}


def compare(before, now):
    """Prints what differs; the number of limits that are broken."""
    broken = 0
    print(f"{'target':34} {'committed':>12} {'now':>12} {'change':>9}")
    for target in sorted(before.keys() | now.keys()):
        old, new = before.get(target, 0), now.get(target, 0)
        grown = new - old > TARGET_GROWTH_BYTES and new > (1 + TARGET_GROWTH) * old
        broken += grown
        if old == 0 or abs(new - old) > 0.01 * old or grown:
            change = f"{100 * (new - old) / old:+.1f} %" if old else "new"
            print(f"{target:34} {old:12} {new:12} {change:>9}{'  MORE' if grown else ''}")
    old, new = sum(before.values()), sum(now.values())
    off = abs(new - old) > SUM_CHANGE * old
    change = f"{100 * (new - old) / old:+.1f} %" if old else "new"
    print(f"{'sum':34} {old:12} {new:12} {change:>9}{'  MORE' if off and new > old else '  LESS' if off else ''}")
    return broken + off


def update(now, built_by, reason):
    rows = "".join(f"{target},{size}\n" for target, size in now.items())
    COMMITTED.write_text(f"# {built_by}\ntarget,bytes\n{rows}")
    version = subprocess.run(["git", "describe", "--always"], cwd=ROOT, capture_output=True, text=True, check=False).stdout.strip()
    if not HISTORY.is_file():
        HISTORY.write_text("# Why the cost of the build moved\n\n")
    with open(HISTORY, "a") as stream:
        stream.write(f"- {datetime.date.today()}, after {version}: {reason} ({sum(now.values()) / 1e6:.0f} MB)\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, usage=argparse.SUPPRESS,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build" / "ci", help=argparse.SUPPRESS)
    parser.add_argument("--update", metavar="REASON", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    build = arguments.build.resolve()
    if not (build / "compile_commands.json").is_file():
        print(f"check_build_cost: there is no {build}/compile_commands.json; ./scripts/build.sh ci makes it", file=sys.stderr)
        return 2
    built_by, before = read_committed()
    here = environment(build)
    now = measured(build)
    broken = compare(before, now)
    if arguments.update:
        update(now, here, arguments.update)
        return 0
    if built_by != here:
        print(f"check_build_cost: the numbers are of {built_by or 'nothing'}, this is {here}; so no change fails", file=sys.stderr)
        return 0
    if broken:
        print('check_build_cost: what was meant: scripts/check_build_cost.py --update "REASON"; where it comes from: '
              "CONTRIBUTING.md", file=sys.stderr)
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
