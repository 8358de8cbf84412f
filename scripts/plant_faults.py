#!/usr/bin/env python3
"""Plants the faults of scripts/planted_faults.toml one at a time and reports which of them no unit test notices.

Usage: scripts/plant_faults.py [--check | --list] [--only PATTERN] [--preset NAME]

Works in build/planted_faults, in a copy of the work tree: the sources of the checkout are only read. The copy and its build
are kept for the next call. Builds the test programs once. Then each fault is planted, what is needed is built and the tests run:
first those of the room that has the fault, then those of the other rooms while none has failed. Prints one line a fault, in the
order of the list. A fault that changes no result has `accepted = "reason"` in the list.
  --check         only check that the text of every fault occurs exactly once in its file (a second)
  --list          only print the faults
  --only PATTERN  faults whose file or description contains this (case does not matter)
  --preset NAME   configure preset of the build (default: ci)
Exit code: 0 when every fault was noticed or is accepted, 1 otherwise or when the list is wrong, 2 for wrong usage, 130 when
interrupted.
"""
import argparse
import filecmp
import json
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
UNIT_LABELS = {"fast", "unit"}  # tests of single rooms
TEST_TIMEOUT_S = 600  # a fault may make a loop endless


class ListError(Exception):
    """An entry of the list that cannot be used."""


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
    """Makes the copy equal to the work tree. Only files that differ are written: the build depends on their times."""
    listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=root, check=True,
                            capture_output=True).stdout.decode().split("\0")
    names = {name for name in listed if name and (root / name).exists()}
    for path in [path for path in tree.rglob("*") if not path.is_dir() or path.is_symlink()]:
        if path.relative_to(tree).as_posix() not in names:
            path.unlink()
    for name in sorted(names):
        source, target = root / name, tree / name
        if target.exists() and filecmp.cmp(source, target, shallow=False):
            continue
        target.parent.mkdir(parents=True, exist_ok=True)
        target.unlink(missing_ok=True)
        shutil.copy(source, target, follow_symlinks=False)


def build(targets):
    """Builds the targets; returns the output if that failed."""
    result = subprocess.run(["cmake", "--build", BUILD, "--target", *targets], stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, text=True, check=False)
    return "" if result.returncode == 0 else result.stdout


def tests_of_ctest():
    """[(name, labels, command)]"""
    listed = subprocess.run(["ctest", "--test-dir", BUILD, "--show-only=json-v1"], check=True, capture_output=True, text=True)
    for test in json.loads(listed.stdout)["tests"]:
        labels = next((p["value"] for p in test.get("properties", []) if p["name"] == "LABELS"), [])
        yield test["name"], set(labels), test.get("command", [])


def targets_of_ctest():
    """Targets of the test programs: those that ctest knows as not built, those that a test builds, and those of unit tests."""
    targets = set()
    for name, labels, command in tests_of_ctest():
        if name.endswith("_NOT_BUILT"):
            targets.add(name.removesuffix("_NOT_BUILT"))
        elif "--target" in command:
            targets.update(command[command.index("--target") + 1:])
        elif UNIT_LABELS & labels and command and BUILD in pathlib.Path(command[0]).parents:
            targets.add(pathlib.Path(command[0]).name)
    return sorted(targets) or ["all"]


def unit_programs():
    """{program: {suite: labels}} of the GoogleTest programs that have tests of single rooms, in the order of ctest."""
    programs = {}
    for name, labels, command in tests_of_ctest():
        if UNIT_LABELS & labels and command and BUILD in pathlib.Path(command[0]).parents:
            programs.setdefault(pathlib.Path(command[0]), {}).setdefault(name.partition(".")[0], set()).update(labels)
    return programs


def suites_of_room(suites, file):
    """The suites of a program that have the room's name as a label, or are in its folder of tests."""
    room = pathlib.PurePosixPath(file).parent
    in_folder = set()
    for path in (TREE / "tests" / room).rglob("*_test.cpp"):
        in_folder.update(re.findall(r"^\w*TEST\w*\((\w+)", path.read_text(), re.MULTILINE))
    return [suite for suite, labels in suites.items() if room.name in labels or in_folder & set(suite.split("/"))]


def run_tests(program, suites=()):
    """The names of the tests that fail, or how the program ended. Without suites: of all tests."""
    name_filter = ":".join(f"{suite}.*" for suite in suites) or "*"
    try:
        result = subprocess.run([program, "--gtest_brief=1", f"--gtest_filter={name_filter}"], cwd=program.parent, text=True,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=TEST_TIMEOUT_S, check=False,
                                errors="replace")
    except subprocess.TimeoutExpired:
        return [f"{program.name}, which takes more than {TEST_TIMEOUT_S} s"]
    failed = list(dict.fromkeys(re.findall(r"^\[  FAILED  \] (\w[\w/.]*)", result.stdout, re.MULTILINE)))
    if result.returncode != 0 and not failed:
        return [f"{program.name}, which ends with {result.returncode}"]
    return failed


def notice(fault, programs):
    """Tests that notice a planted fault: those of its room, else those of the first program that has any."""
    own = {program: found for program, suites in programs.items() if (found := suites_of_room(suites, fault["file"]))}
    others = [program for program in programs if program not in own]
    for program, suites in [*own.items(), *((program, ()) for program in [*own, *others])]:
        if output := build([program.name]):
            raise ListError(f"{fault['file']}: `{fault['new']}` does not compile:\n{output[-3000:]}")
        if failed := run_tests(program, suites):
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


def prepare(preset):
    """Builds the test programs and runs them without a fault. Returns unit_programs()."""
    copy_tree(ROOT, TREE)
    subprocess.run(["cmake", "--preset", preset, "-S", TREE, "-B", BUILD], cwd=TREE, check=True, stdout=subprocess.DEVNULL)
    if output := build(targets_of_ctest()):
        sys.exit(f"{output[-3000:]}\nplant_faults: the tests do not build without a fault")
    programs = unit_programs()
    for program in programs:
        if failed := run_tests(program):
            sys.exit(f"plant_faults: without a fault these fail: {', '.join(failed)}")
    return programs


def run_all(faults, preset):
    """Prints a line a fault and a summary; returns the number of faults that survive without being accepted."""
    programs = prepare(preset)
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
        took = f"({time.monotonic() - began:.0f} s)"
        print(f"{number:3}/{len(faults)}  {fault['file']}: {fault['what']}: {verdict} {took}", flush=True)
    print(f"{len(faults)} faults: {len(faults) - len(survivors) - accepted} noticed, {accepted} accepted, "
          f"{len(survivors)} survived")
    for fault in survivors:
        print(f"survived: {fault['file']}: {fault['what']}")
    return len(survivors)


def main():
    parser = argparse.ArgumentParser(description=__doc__, usage=argparse.SUPPRESS,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
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
    except (ListError, tomllib.TOMLDecodeError, subprocess.CalledProcessError) as error:
        print(f"plant_faults: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("plant_faults: interrupted", file=sys.stderr)
        return 130


if __name__ == "__main__":
    sys.exit(main())
