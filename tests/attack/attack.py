#!/usr/bin/env python3
"""Attacks the program with mutated inputs of every kind, on every verb, and checks what it owes whatever it is given.

Usage: tests/attack/attack.py BINARY [--seconds N | --count N] [--seed S] [--workers N] [--only KIND] [--keep FOLDER]
                                     [--no-memory-limit] [--preload LIBRARY]
       tests/attack/attack.py BINARY --replay FILE.json...     cases that were kept, and what they do now
       tests/attack/attack.py BINARY --case SEED:NUMBER        one case again, with its folder kept and its output shown

Inputs are valid ones (seeds.py), changed by mutations that know their structure (mutate.py), given to commands that read them
(commands.py); oracle.py says what is checked. The same binary, seed and number make the same case. A finding is printed and kept as
FOLDER/KIND_SEED_NUMBER.json, which holds the changed files and the command. Exit code: 0 nothing found, 1 findings, 2 usage.
"""

import argparse
import base64
import collections
import json
import multiprocessing
import os
import pathlib
import queue
import random
import re
import shutil
import subprocess
import sys
import tempfile
import time

import commands
import mutate
import oracle
import seeds
import server

CASES_A_REPORT = 200
KINDS = {"recording": 40, "trajectory": 14, "mesh": 8, "text": 12, "runs": 18, "archive": 4, "options": 4}


class Case:
    def __init__(self, kind, base, changes, arguments):
        self.kind, self.base, self.changes, self.arguments = kind, base, changes, arguments

    def to_json(self):
        def said(change):
            if "bytes" not in change:
                return change
            try:
                text = change["bytes"].decode("ascii")
                return {"text": text}
            except UnicodeDecodeError:
                return {"base64": base64.b64encode(change["bytes"]).decode()}
        return {"kind": self.kind, "base": self.base, "arguments": self.arguments,
                "changes": {name: said(change) for name, change in self.changes.items()}}

    @staticmethod
    def from_json(document):
        def meant(change):
            if "text" in change:
                return {"bytes": change["text"].encode()}
            return {"bytes": base64.b64decode(change["base64"])} if "base64" in change else change
        changes = {name: meant(change) for name, change in document["changes"].items()}
        return Case(document["kind"], document["base"], changes, document["arguments"])


def suite_of_all(name):
    return f'name = "s"\nrecordings = ["{name}"]\nvariants = ["no-imu", "full"]\nimu = "auto"\n[config]\niekf.min_patches = 1\ntsdf.max_blocks = 50000\n'


class Maker:
    """Draws cases from the seeds."""

    def __init__(self, folder, files, helps):
        self.folder, self.files, self.helps = pathlib.Path(folder), files, helps
        self.contents = {}

    def content(self, base, name):
        if (base, name) not in self.contents:
            self.contents[base, name] = (self.folder / base / name).read_bytes()
        return self.contents[base, name]

    def changed(self, rng, base, changes, name):
        change = changes.get(name, {"bytes": self.content(base, name)})
        if "bytes" not in change:
            return
        changes[name] = mutate.of_file(rng) if rng.random() < 0.04 else {"bytes": mutate.of_content(rng, name, change["bytes"])}

    def changes(self, rng, base, wanted):
        """One to four mutations, most often of one file; wanted(name) are the files that matter."""
        names = [name for name in self.files[base] if wanted(name)]
        changes = {}
        name = rng.choice(names)
        for _ in range(rng.choice([1, 1, 1, 2, 2, 4])):
            self.changed(rng, base, changes, name)
            if rng.random() < 0.3:
                name = rng.choice(names)
        if rng.random() < 0.02:
            name = rng.choice(names)
            changes[name] = {"remove": True}
            changes[os.fsdecode(os.fsencode(name) + rng.choice([b"\xff", b"\x1b", b"\n", b" ", b".bak"]))] = {
                "bytes": self.content(base, name)}
        return changes

    def make(self, seed, number, only=None):
        rng = random.Random(f"{seed}:{number}")
        kind = only or rng.choices(list(KINDS), list(KINDS.values()))[0]
        if kind == "options":
            return self.of_options(rng)
        case = getattr(self, "of_" + kind)(rng)
        if rng.random() < 0.06:
            case.arguments = commands.with_option(rng, case.arguments, self.helps)
        return case

    def of_recording(self, rng):
        base = rng.choice(commands.RECORDINGS)
        # Lists, calibrations and truth are read by more than images are.
        images = rng.random() < 0.25
        names = [n for n in self.files[base] if n.endswith((".png", ".exr")) == images and not n.endswith("scene.ply")]
        changes = self.changes(rng, base, lambda name: name in names if names else True)
        arguments = commands.recording_command(rng, base)
        if arguments[0] == "bench":
            changes["suite_of_all.toml"] = {"bytes": suite_of_all(commands.place_of(base).split(".")[0]).encode()}
        return Case("recording", base, changes, arguments)

    def of_trajectory(self, rng):
        arguments = commands.trajectory_command(rng)
        named = [word for word in arguments if word in self.files["trajectories"]]
        case = Case("trajectory", "trajectories", self.changes(rng, "trajectories", lambda name: name in named), arguments)
        if arguments[0] == "import":
            for name in self.files["tum"]:
                case.changes[name] = {"seed": f"tum/{name}"}
        return case

    def of_mesh(self, rng):
        arguments = commands.mesh_command(rng)
        named = [word for word in arguments if word in self.files["meshes"]]
        return Case("mesh", "meshes", self.changes(rng, "meshes", lambda name: name in named), arguments)

    def of_text(self, rng):
        name = rng.choice(["suite.toml", "suite.toml", "made.toml", "system.toml", "options.toml", "few.toml"])
        changes = self.changes(rng, "texts", lambda other: other == name)
        arguments = commands.text_command(rng, name)
        text = changes.get("made.toml", {}).get("bytes", b"")
        # What asks for minutes of images gets them.
        if name == "made.toml" and not all(part in text for part in (b"\nduration_s = 0.1\n", b"\nsize = \"32x24\"\n", b"samples = 1\n",
                                                                     b"samples = 3\n")):
            arguments.append("--dry-run")
        return Case("text", "texts", changes, arguments)

    def of_runs(self, rng):
        names = [name for name in self.files["runs"] if name.startswith(("runs/", "other/"))]
        records = [name for name in names if name.endswith("record.json")]
        gates = rng.random() < 0.15
        few = ["gates.toml"] if gates else records if rng.random() < 0.5 else names
        changes = self.changes(rng, "runs", lambda name: name in few)
        arguments = ["compare", "other", "runs", "--gates", "gates.toml"] if gates else commands.runs_command(rng)
        arguments = [self.with_hash(word) for word in arguments]
        return Case("runs", "runs", changes, arguments)

    def with_hash(self, word):
        """runs/tum/no-imu/@ with the name of the first folder or file there."""
        if "@" not in word:
            return word
        before, after = word.split("@")
        name = next(n for n in self.files["runs"] if n.startswith(before) and n.endswith(after))
        return before + name[len(before):].split("/")[0].removesuffix(after) + after

    def of_archive(self, rng):
        return Case("archive", "archives", self.changes(rng, "archives", lambda name: True), commands.archive_command(rng))

    def of_options(self, rng):
        """Valid inputs, and options that are not."""
        how = rng.randrange(5)
        base = rng.choice(["tum", "zr300", "icl"])
        choices = {0: (base, lambda: commands.recording_command(rng, base)), 1: ("trajectories", lambda: commands.trajectory_command(rng)),
                   2: ("meshes", lambda: commands.mesh_command(rng)), 3: ("texts", lambda: commands.text_command(rng, "suite.toml")),
                   4: ("runs", lambda: [self.with_hash(word) for word in commands.runs_command(rng)])}
        base, drawn = choices[how]
        arguments = drawn()
        while arguments[0] in ("import",) or "suite_of_all.toml" in arguments:
            arguments = drawn()
        for _ in range(rng.choice([1, 1, 2])):
            arguments = commands.with_option(rng, arguments, self.helps)
        return Case("options", base, {}, arguments)


def link_or_copy(source, target, must_copy=False):
    try:
        if not must_copy:
            os.link(source, target)
            return
    except OSError:  # another file system
        pass
    shutil.copyfile(source, target)


def lay_out(case, seeds_folder, files, folder):
    """The case's files, unchanged ones as links to the seeds."""
    base = os.path.join(seeds_folder, case.base)
    made = set()
    for name in files[case.base]:
        if name in case.changes:
            continue
        parent = os.path.join(folder, os.path.dirname(name))
        if parent not in made:
            os.makedirs(parent, exist_ok=True)
            made.add(parent)
        # What the program writes into is copied.
        link_or_copy(os.path.join(base, name), os.path.join(folder, name), case.base == "runs")
    for name, change in case.changes.items():
        path = os.path.join(folder, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        if "bytes" in change:
            with open(path, "wb") as file:
                file.write(change["bytes"])
        elif "seed" in change:
            link_or_copy(os.path.join(seeds_folder, change["seed"]), path)
        elif "folder" in change:
            os.makedirs(path)
        elif "fifo" in change:
            os.mkfifo(path)
        elif "link" in change:
            os.symlink(change["link"], path)
        elif "sparse" in change:
            with open(path, "wb") as file:
                file.truncate(change["sparse"])


class Runner:
    """Runs cases in a scratch folder of its own."""

    def __init__(self, options, seeds_folder, files, scratch):
        self.options, self.seeds_folder, self.files = options, seeds_folder, files
        self.scratch = pathlib.Path(scratch)
        self.scratch.mkdir(parents=True, exist_ok=True)
        self.program = server.Program(options.binary, server.find_library(options.binary, "libfusebench_fork_server.so"),
                                      options.preload)
        self.limits = server.Limits()
        if options.no_memory_limit:
            self.limits.memory_mb = 0

    def run(self, case):
        folder = self.scratch / "case"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        lay_out(case, self.seeds_folder, self.files, str(folder))
        before = oracle.listing(folder)
        output, errors = str(self.scratch / "stdout"), str(self.scratch / "stderr")
        arguments = case.arguments
        answer = self.program.run(str(folder), arguments, output, errors, self.limits)
        with open(output, "rb") as file:
            said = file.read()
        with open(errors, "rb") as file:
            complained = file.read()
        return answer, oracle.problems(answer, folder, before, said, complained, arguments), said, complained


def signature(case, problem, errors):
    """Findings of one signature have one cause, most likely."""
    sentence = next((line for line in errors.decode(errors="replace").split("\n") if line.startswith("error: ")), "")
    sentence = re.sub(r"[-+]?\d[\w.+-]*", "0", re.sub(r"'[^']*'", "''", sentence))[-60:]
    verb = " ".join(case.arguments[:2]) if case.arguments[0] == "eval" else case.arguments[0]
    return f"{verb}: {problem}" + (f" ({sentence})" if "errors" in problem or "exit code" in problem else "")


def work(options, seeds_folder, files, helps, worker, results, deadline):
    runner = Runner(options, seeds_folder, files, pathlib.Path(options.scratch) / f"worker{worker}")
    maker = Maker(seeds_folder, files, helps)
    number = worker
    seen = collections.Counter()
    statuses = collections.Counter()
    while number < options.count and time.monotonic() < deadline:
        case = maker.make(options.seed, number, options.only)
        answer, problems, _, errors = runner.run(case)
        statuses[answer.status] += 1
        # A worker that dies later must not take with it what it has done.
        if statuses.total() == CASES_A_REPORT:
            results.put(("done so far", dict(statuses)))
            statuses.clear()
        for problem in problems:
            name = signature(case, problem, errors)
            seen[name] += 1
            if seen[name] <= 2:
                results.put(("finding", name, number, case.to_json(), errors[:400].decode(errors="replace")))
        number += options.workers
    results.put(("done so far", dict(statuses)))
    results.put(("ended", dict(seen)))
    runner.program.close()


def program_of(binary):
    """A function that runs the program and expects one of the codes."""
    def run(*arguments, cwd=None, codes=(0,)):
        done = subprocess.run([binary, *map(str, arguments)], cwd=cwd, capture_output=True, text=True, stdin=subprocess.DEVNULL,
                              check=False)
        if done.returncode not in codes:
            raise SystemExit(f"attack: {arguments} ends with {done.returncode}: {done.stderr}")
        return done.stdout
    return run


def helps_of(program):
    verbs = [(verb,) for verb in ("run", "bench", "best", "collect", "compare", "gc", "merge", "rerun", "slurm-task", "table", "report",
                                  "import", "list", "config", "simulate", "inspect", "export", "convert", "calibrate", "smooth")]
    verbs += [("eval", verb) for verb in ("ate", "rpe", "traj", "res", "nees", "silent", "mesh", "aie")]
    return {verb: commands.options_of(program("help", *verb)) for verb in verbs}


def attack(options, seeds_folder, files, helps):
    results = multiprocessing.Queue()
    begun = time.monotonic()
    deadline = begun + options.seconds
    workers = [multiprocessing.Process(target=work, args=(options, seeds_folder, files, helps, worker, results, deadline))
               for worker in range(options.workers)]
    for worker in workers:
        worker.start()
    statuses, seen, shown = collections.Counter(), collections.Counter(), set()
    left = len(workers)
    while left > 0:
        try:
            result = results.get(timeout=5)
        except queue.Empty:
            if any(worker.exitcode for worker in workers):
                print("attack: a worker has died", file=sys.stderr)
                for worker in workers:
                    worker.kill()
                break
            continue
        if result[0] == "ended":
            left -= 1
            seen.update(result[1])
            continue
        if result[0] == "done so far":
            statuses.update(result[1])
            continue
        _, name, number, case, errors = result
        if name in shown:
            continue
        shown.add(name)
        kept = pathlib.Path(options.keep) / f"{case['kind']}_{options.seed}_{number}.json"
        kept.parent.mkdir(parents=True, exist_ok=True)
        case = json.loads(re.sub(r"/[0-9a-f]{8}(?=[/\"])", "/@", json.dumps(case)))
        kept.write_text(json.dumps({"finding": name, "said": errors, **case}, indent=1) + "\n")
        print(f"FINDING {name}\n    {kept}: fusebench {' '.join(map(ascii, case['arguments']))}\n    {errors[:200]!r}", flush=True)
    took = time.monotonic() - begun
    codes = ", ".join(f"{status}: {count}" for status, count in sorted(statuses.items()))
    cases = statuses.total()
    print(f"attack: {cases} cases with seed {options.seed} in {took:.0f} s ({cases / max(took, 1e-9):.0f} a second); exit codes {codes}; "
          f"{sum(seen.values())} findings of {len(seen)} kinds")
    for name, count in seen.most_common():
        print(f"  {count:6} {name}")
    return 1 if seen or shown or left > 0 else 0


def named(text, files):
    """A name with @ for a folder that is called by a hash: that of the files which fits. Hashes change with the estimator."""
    if "@" not in text:
        return text
    pattern = re.compile("[0-9a-f]{8}".join(map(re.escape, text.split("@"))))
    return next((match.group() for match in map(pattern.match, files) if match), text)


def replay(options, seeds_folder, files):
    runner = Runner(options, seeds_folder, files, pathlib.Path(options.scratch) / "replay")
    failures = 0
    for name in options.replay:
        document = json.loads(pathlib.Path(name).read_text())
        case = Case.from_json(document)
        case.changes = {named(changed, files[case.base]): change for changed, change in case.changes.items()}
        case.arguments = [named(word, files[case.base]) for word in case.arguments]
        answer, problems, output, errors = runner.run(case)
        if problems:
            failures += 1
            print(f"FINDING {name}: {'; '.join(problems)}\n    exit code {answer.status}, {answer.cpu_ms} ms, {answer.peak_mb} MB\n    "
                  f"{errors[:300].decode(errors='replace')}")
        elif options.verbose:
            print(f"{name}: exit code {answer.status}, {answer.cpu_ms} ms: {errors[:300].decode(errors='replace').strip()}")
    runner.program.close()
    print(f"attack: {len(options.replay)} kept cases, {failures} with findings")
    return 1 if failures else 0


def one_case(options, seeds_folder, files, helps):
    seed, number = map(int, options.case.split(":"))
    case = Maker(seeds_folder, files, helps).make(seed, number, options.only)
    print(json.dumps(case.to_json(), indent=1)[:4000])
    runner = Runner(options, seeds_folder, files, pathlib.Path(options.scratch) / "one")
    kept = pathlib.Path(options.keep) / f"case_{seed}_{number}"
    shutil.rmtree(kept, ignore_errors=True)
    kept.mkdir(parents=True)
    lay_out(case, seeds_folder, files, str(kept))
    answer, problems, output, errors = runner.run(case)
    print(answer, problems, output.decode(errors="replace"), errors.decode(errors="replace"), sep="\n")
    print("as it was before:", kept)
    return 1 if problems else 0


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("\n\n")[1], add_help=False)
    parser.add_argument("binary")
    parser.add_argument("--seconds", type=float, default=None)
    parser.add_argument("--count", type=int, default=None)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--workers", type=int, default=os.cpu_count())
    parser.add_argument("--only", choices=list(KINDS))
    parser.add_argument("--keep", default="build/attack")
    parser.add_argument("--no-memory-limit", action="store_true")
    parser.add_argument("--preload", action="append", default=[])
    parser.add_argument("--replay", nargs="+")
    parser.add_argument("--case")
    parser.add_argument("--verbose", action="store_true")
    options = parser.parse_args()
    options.binary = os.path.realpath(options.binary)
    if options.seconds is None:
        options.seconds = 60 if options.count is None else float("inf")
    options.count = options.count if options.count is not None else sys.maxsize
    room = "/dev/shm" if os.path.isdir("/dev/shm") and os.access("/dev/shm", os.W_OK) else None
    with tempfile.TemporaryDirectory(prefix="fusebench_attack_", dir=room) as scratch:
        options.scratch = scratch
        program = program_of(options.binary)
        seeds_folder = os.path.join(scratch, "seeds")
        files = seeds.make(program, seeds_folder)
        if options.replay:
            return replay(options, seeds_folder, files)
        helps = helps_of(program)
        if options.case:
            return one_case(options, seeds_folder, files, helps)
        return attack(options, seeds_folder, files, helps)


if __name__ == "__main__":
    sys.exit(main())
