#!/usr/bin/env python3
"""Plants the faults of scripts/planted_faults.toml one at a time and reports which of them no unit test notices.

Usage: scripts/plant_faults.py [--check | --list] [--only PATTERN] [--preset NAME]

Works in a copy of the files that git tracks, build/planted_faults/tree, which is deleted at the end; the objects in
build/planted_faults/build are kept for the next call. Builds the test programs once. Then each fault is planted, the programs are
built and the tests run: first those of the room that has the fault, then those of the other rooms while none has failed.
Prints one line a fault. A fault that changes no result has `accepted = "reason"` in the list.
  --check        only check that the text of every fault occurs exactly once in its file (one second)
  --list         only print the faults
  --only PATTERN faults whose file or description contains this (case does not matter)
  --preset NAME  configure preset of the build (default: ci)
Exit code: 0 when every fault was noticed or is accepted, 1 otherwise or when the list is wrong, 2 for wrong usage.
"""
import argparse
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import time
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
LIST = "scripts/planted_faults.toml"
SCRATCH = ROOT / "build" / "planted_faults"
TREE = SCRATCH / "tree"
BUILD = SCRATCH / "build"
LAYERS = ("core", "datasets", "eval")
UNIT_LABELS = {"fast", "unit"}  # tests of single rooms
TEST_TIMEOUT_S = 600  # a fault may make a loop endless


class ListError(Exception):
    """An entry of the list that cannot be used."""


def room_of(file):
    """The folder that has a source: its name is the label of its tests."""
    return pathlib.PurePosixPath(file).parent.name


def read_faults(root):
    """The entries in the order of the list. Raises ListError."""
    with open(root / LIST, "rb") as stream:
        faults = tomllib.load(stream).get("fault", [])
    for number, fault in enumerate(faults, 1):
        missing = {"what", "file", "old", "new"} - fault.keys()
        unknown = fault.keys() - {"what", "file", "old", "new", "accepted"}
        if missing or unknown:
            raise ListError(f"{LIST}: fault {number}: keys missing: {sorted(missing)}, not allowed: {sorted(unknown)}")
    return faults


def check_faults(root, faults):
    """One line for each entry whose text does not occur exactly once."""
    problems = []
    for fault in faults:
        path = root / fault["file"]
        count = path.read_text().count(fault["old"]) if path.is_file() else 0
        if count != 1:
            problems.append(f"{fault['file']}: `{fault['old']}` occurs {count} times (allowed: once)")
        if fault["old"] == fault["new"]:
            problems.append(f"{fault['file']}: `{fault['old']}` is replaced by itself")
    return problems


def copy_tree(root, tree):
    """A copy of what git tracks, with the changes of the work tree; files that did not change keep their time."""
    tracked = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=root, check=True,
                             capture_output=True).stdout
    for name in filter(None, tracked.decode().split("\0")):
        source, target = root / name, tree / name
        if not source.exists():  # deleted, but not yet in git
            continue
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(source, target, follow_symlinks=False)


def configure(preset):
    subprocess.run(["cmake", "--preset", preset, "-S", TREE, "-B", BUILD], cwd=TREE, check=True, stdout=subprocess.DEVNULL)


def build(targets):
    """Builds the targets; returns the output if that failed."""
    result = subprocess.run(["cmake", "--build", BUILD, "--target", *targets], stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, text=True, check=False)
    return "" if result.returncode == 0 else result.stdout


def source_folders_of_targets():
    """{target: folders below tests that its objects are compiled from}, from the build's own list of commands."""
    folders = {}
    for command in json.loads((BUILD / "compile_commands.json").read_text()):
        target = re.search(r"CMakeFiles/(\w+)\.dir/", command.get("output", "") or command["command"])
        if not target:
            continue
        text = pathlib.Path(command["file"])
        sources = re.findall(r'#include "([^"]+)"', text.read_text()) if "/Unity/" in command["file"] else [command["file"]]
        for source in sources:
            path = pathlib.Path(source)
            if path.is_relative_to(TREE / "tests"):
                folders.setdefault(target[1], set()).add(path.relative_to(TREE / "tests").parts[:-1])
    return folders


def test_programs(targets):
    """[(target, program, rooms)] of the GoogleTest programs that have tests of single rooms, in the order of ctest."""
    listed = subprocess.run(["ctest", "--test-dir", BUILD, "--show-only=json-v1"], check=True, capture_output=True, text=True)
    programs = {}
    for test in json.loads(listed.stdout)["tests"]:
        labels = next((p["value"] for p in test.get("properties", []) if p["name"] == "LABELS"), [])
        command = test.get("command", [])
        if not command or not UNIT_LABELS & set(labels) or pathlib.Path(command[0]).name not in targets:
            continue
        programs.setdefault(command[0], set()).update(labels)
    return [(pathlib.Path(path).name, path, labels | {folder[-1] for folder in targets[pathlib.Path(path).name] if folder})
            for path, labels in programs.items()]


def unit_targets(folders):
    """Targets of tests of the layers, by name: ctest knows their tests once they are built."""
    return sorted(target for target, parts in folders.items()
                  if target.endswith("tests") and any(part and part[0] in LAYERS for part in parts))


def run_tests(program, name_filter="*"):
    """The names of the tests that fail, or what ended the program."""
    try:
        result = subprocess.run([program, "--gtest_brief=1", f"--gtest_filter={name_filter}"], cwd=BUILD, text=True,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=TEST_TIMEOUT_S, check=False,
                                errors="replace")
    except subprocess.TimeoutExpired:
        return [f"{pathlib.Path(program).name} takes more than {TEST_TIMEOUT_S} s"]
    failed = list(dict.fromkeys(re.findall(r"^\[  FAILED  \] (\w[\w/.]*)", result.stdout, re.MULTILINE)))
    if result.returncode != 0 and not failed:
        return [f"{pathlib.Path(program).name} ends with {result.returncode}"]
    return failed


def names_of_tests(folder):
    """The GoogleTest suites of a folder below tests, as a filter; empty if it has none."""
    suites = set()
    for path in sorted((TREE / "tests" / folder).rglob("*_test.cpp")):
        suites.update(re.findall(r"^(?:TYPED_)?TEST(?:_F|_P)?\((\w+)", path.read_text(), re.MULTILINE))
    return ":".join(f"{suite}.*:*/{suite}.*" for suite in sorted(suites))


def notice(fault, programs):
    """Tests that notice a planted fault: those of its room, else the first that do among all others."""
    room = room_of(fault["file"])
    own = [program for program in programs if room in program[2]]
    own_filter = names_of_tests(pathlib.PurePosixPath(fault["file"]).parent)
    steps = [(program, own_filter) for program in own if own_filter]
    steps += [(program, "*") for program in own + [program for program in programs if program not in own]]
    for (target, path, _), name_filter in steps:
        output = build([target])
        if output:
            raise ListError(f"{fault['file']}: `{fault['new']}` does not compile:\n{output[-3000:]}")
        failed = run_tests(path, name_filter)
        if failed:
            return failed
    return []


def plant(fault, programs):
    """Plants one fault, runs the tests and takes it back. Returns the tests that notice it."""
    path = TREE / fault["file"]
    text = path.read_text()
    try:
        path.write_text(text.replace(fault["old"], fault["new"]))
        return notice(fault, programs)
    finally:
        path.write_text(text)


def run_all(faults, preset):
    """Prints a line a fault and a summary; returns the number of faults that survive without being accepted."""
    copy_tree(ROOT, TREE)
    configure(preset)
    targets = source_folders_of_targets()
    output = build(unit_targets(targets))
    if output:
        sys.exit(f"{output[-3000:]}\nplant_faults: the tests do not build without a fault")
    programs = test_programs(targets)
    for target, path, _ in programs:
        if failed := run_tests(path):
            sys.exit(f"plant_faults: tests of {target} fail without a fault: {', '.join(failed)}")
    survivors, accepted = [], 0
    for number, fault in enumerate(faults, 1):
        began = time.monotonic()
        found = plant(fault, programs)
        if found:
            verdict = f"noticed by {found[0]}" + (f" and {len(found) - 1} more" if len(found) > 1 else "")
        elif "accepted" in fault:
            verdict = f"accepted: {fault['accepted']}"
            accepted += 1
        else:
            verdict = "SURVIVED"
            survivors.append(fault)
        print(f"{number:3}/{len(faults)}  {fault['file']}: {fault['what']}: {verdict} ({time.monotonic() - began:.0f} s)", flush=True)
    print(f"{len(faults)} faults: {len(faults) - len(survivors) - accepted} noticed, {accepted} accepted, "
          f"{len(survivors)} survived")
    for fault in survivors:
        print(f"survived: {fault['file']}: {fault['what']}")
    return len(survivors)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter, usage=argparse.SUPPRESS)
    parser.add_argument("--check", action="store_true", help=argparse.SUPPRESS)
    parser.add_argument("--list", action="store_true", help=argparse.SUPPRESS)
    parser.add_argument("--only", default="", help=argparse.SUPPRESS)
    parser.add_argument("--preset", default="ci", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    try:
        faults = read_faults(ROOT)
        if problems := check_faults(ROOT, faults):
            print("\n".join(problems), file=sys.stderr)
            return 1
        wanted = arguments.only.lower()
        faults = [fault for fault in faults if wanted in f"{fault['file']} {fault['what']}".lower()]
        if arguments.check:
            print(f"{len(faults)} faults, each of them occurs once")
            return 0
        if arguments.list:
            print("\n".join(f"{fault['file']}: {fault['what']}" for fault in faults))
            return 0
        if not faults:
            print(f"plant_faults: no fault matches '{arguments.only}'", file=sys.stderr)
            return 2
        signal.signal(signal.SIGTERM, signal.default_int_handler)
        return 1 if run_all(faults, arguments.preset) else 0
    except (ListError, tomllib.TOMLDecodeError) as error:
        print(f"plant_faults: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("plant_faults: interrupted", file=sys.stderr)
        return 130
    finally:
        shutil.rmtree(TREE, ignore_errors=True)


if __name__ == "__main__":
    os.umask(0o022)
    sys.exit(main())
