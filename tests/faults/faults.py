#!/usr/bin/env python3
"""Lets the n-th call of a kind fail while the program writes results, for every n, and checks what is left.

Usage: tests/faults/faults.py BINARY [--every | --sample N] [--only STEP] [--kind KIND]

--sample N (default 3): at most N places of each kind in each step, spread over all of them; --every: all, but for allocations, of
which there are up to a million: 200. After each failure:
- the exit code is one of the table, no signal (but for an allocation in a destructor), and 0 only with an undisturbed run's results;
- otherwise one sentence says what could not be done, with a file's name where a file was concerned;
- nothing is left of the step: the folder is as before, or, of suites, whole runs only;
- the same command again ends with the bytes of an undisturbed one (but for times).
Prints a table: step, kind, calls, faults, outcomes. Exit code: 0 all kept, 1 not, 2 usage. failing_calls.cpp injects the faults.
"""

import argparse
import errno
import hashlib
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "attack"))

import oracle  # noqa: E402
import seeds  # noqa: E402
import server  # noqa: E402

KINDS = {"write": errno.ENOSPC, "sync": errno.EIO, "rename": errno.EIO, "create": errno.ENOSPC, "open": errno.EMFILE,
         "map": errno.ENOMEM, "fork": errno.EAGAIN, "allocate": errno.ENOMEM}
SUITE = seeds.SUITE.split("[[sweep]]")[0].replace('"no-imu", "dm-no-imu"', '"no-imu"')
STEPS = {
    "run": ["run", "tum", "--variant", "no-imu", "--set", "iekf.min_patches=1", "--threads", "1", "--out", "out"],
    "bench": ["bench", "suite.toml", "--data", ".", "--threads", "1", "--out", "out"],
    "bench -j 2": ["bench", "suite.toml", "--data", ".", "--threads", "1", "-j", "2", "--out", "out"],
    "rerun": ["bench", "suite.toml", "--data", ".", "--threads", "1", "--out", "runs"],
    "report": ["report", "runs", "--out", "out.html"],
    "collect": ["collect", "runs", "--out", "out.csv"],
    "merge": ["merge", "runs", "--into", "out"],
    "import": ["import", "Other", "tum/groundtruth.txt", "tum/scene.ply", "--recording", "tum", "--imu", "none", "--out", "out"],
    "export sens": ["export", "tum", "--format", "sens", "--out", "out.sens"],
    "export euroc": ["export", "tum", "--format", "euroc", "--out", "out"],
    "convert": ["convert", "tum", "--out", "out"],
    "inspect --page": ["inspect", "tum", "--page", "out.html", "--threads", "1"],
    "eval --save_results": ["eval", "ate", "tum/groundtruth.txt", "tum/groundtruth.txt", "--save_results", "out.zip"],
    "eval --errors": ["eval", "ate", "tum/groundtruth.txt", "tum/groundtruth.txt", "--errors", "out.csv"],
    "eval --colored": ["eval", "mesh", "tum/scene.ply", "tum/scene.ply", "--samples", "200", "--threads", "1", "--colored", "out.ply"],
    "simulate": ["simulate", "--format", "tum", "--size", "32x24", "--duration", "0.1", "--blur-samples", "1", "--threads", "1",
                 "--scene", "tum/scene.ply", "--trajectory", "path.txt", "--out", "out"],
}
SYNCED = ("run", "bench", "import", "export sens", "export euroc", "convert", "simulate", "merge")
KEEPS_PARTS = ("bench", "bench -j 2", "rerun", "merge")  # whole runs


def content(folder):
    """{file: hash} without what is never the same twice: timing and provenance of records, milliseconds of frames, invocations."""
    found = {}
    for path in sorted(pathlib.Path(folder).rglob("*")):
        name = str(path.relative_to(folder))
        if not path.is_file() or name.startswith((".fusebench", "stdout", "stderr")) or "/.fusebench/" in name:
            continue
        data = path.read_bytes()
        if name.endswith("record.json"):
            data = data.split(b'\n  "timing"')[0]
        elif name.endswith("frames.csv"):
            data = re.sub(rb"(,[^,\n]*){6}$", b"", data, flags=re.M)
        elif name.endswith("trace.json"):
            data = b""
        found[name] = hashlib.sha256(data).hexdigest()
    return found


class Faults:
    def __init__(self, binary, scratch):
        self.binary = os.path.realpath(binary)
        self.library = server.find_library(self.binary, "libfusebench_failing_calls.so")
        self.scratch = pathlib.Path(scratch)
        self.inputs = self.scratch / "inputs"
        program = self.program()
        seeds.simulated(self.inputs / "tum", program, "tum")
        seeds.write(self.inputs / "suite.toml", SUITE)
        seeds.write(self.inputs / "path.txt", "".join(f"{0.1 * k} {0.5 + 0.01 * k} 0.5 1 0 0 0 1\n" for k in range(30)))
        program("bench", "suite.toml", "--data", ".", "--out", "runs", "--threads", "1", cwd=self.inputs)
        # One run is missing, for `rerun` to make.
        shutil.rmtree(sorted((self.inputs / "runs" / "tum" / "no-imu").iterdir())[0])
        self.failures = []

    def program(self):
        def run(*arguments, cwd=None, codes=(0,)):
            done = subprocess.run([self.binary, *map(str, arguments)], cwd=cwd, capture_output=True, text=True, check=False)
            if done.returncode not in codes:
                raise SystemExit(f"faults: {arguments} ends with {done.returncode}: {done.stderr}")
            return done.stdout
        return run

    def command(self, folder, arguments, kind=None, at=0):
        """(exit code, standard error, lines of the log)."""
        environment = {name: value for name, value in os.environ.items() if not name.startswith(("FUSEBENCH", "FAULTS"))}
        log = self.scratch / "log"
        log.unlink(missing_ok=True)
        if kind:
            environment.update(LD_PRELOAD=str(self.library), FAULTS_KIND=kind, FAULTS_AT=str(at), FAULTS_ERROR=str(KINDS.get(kind, 0)),
                               FAULTS_LOG=str(log))
        try:
            done = subprocess.run([self.binary, *arguments], cwd=folder, env=environment, stdin=subprocess.DEVNULL,
                                  capture_output=True, timeout=120, check=False)
        except subprocess.TimeoutExpired:
            return None, b"", []
        return done.returncode, done.stderr, log.read_text(errors="replace").splitlines() if log.exists() else []

    def fresh(self):
        folder = self.scratch / "work"
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(self.inputs, folder)
        return folder

    def complain(self, step, kind, at, what, errors):
        self.failures.append(f"{step}, {kind} {at}: {what}")
        print(f"FAILED: {self.failures[-1]}\n    {errors[-400:].decode(errors='replace').strip()}", flush=True)

    def one(self, step, kind, at, undisturbed):
        """The outcome of one fault: a word; None if that many calls are not made."""
        folder = self.fresh()
        before = oracle.listing(folder)
        status, errors, log = self.command(folder, STEPS[step], kind, at)
        failed = next((line for line in log if line.startswith("FAILED ")), None)
        if status is None:
            self.complain(step, kind, at, "hangs", errors)
            return "hangs"
        if failed is None:
            return None
        # The JSON library takes memory in destructors, where a failure ends the process: as a kill does, it may leave what `gc` removes.
        is_killed = kind == "allocate" and status == -signal.SIGABRT
        if not is_killed:
            self.check_after(step, kind, at, folder, before, (status, errors, failed), undisturbed)
        for left in list(folder.rglob(".*.tmp")) if is_killed else []:
            shutil.rmtree(left, ignore_errors=True)
        code, said, _ = self.command(folder, STEPS[step])
        if code == 2 and b"exists already" in said:
            code = undisturbed[0]  # what stands there is complete, or the bytes differ
        if code != undisturbed[0] or content(folder) != undisturbed[1]:
            different = [name for name in set(undisturbed[1]) | set(content(folder)) if content(folder).get(name) != undisturbed[1].get(name)]
            self.complain(step, kind, at, f"the second try ends with {code}, and {sorted(different)[:3]} differ", said)
        return "went on" if status == undisturbed[0] else "as if killed" if is_killed else f"exit code {status}"

    def check_after(self, step, kind, at, folder, before, ended, undisturbed):
        status, errors, failed = ended
        where = f"{kind}: {failed}"
        if status not in oracle.EXIT_CODES:
            self.complain(step, kind, at, f"exit code {status} ({where})", errors)
            return
        if b"this is a bug" in errors or b"terminate called" in errors:
            self.complain(step, kind, at, f"says that it is a bug ({where})", errors)
        new = oracle.listing(folder) - before
        if content(folder) == undisturbed[1]:
            new = set()  # complete: only that it will survive a power cut could not be made sure
        half = sorted(name for name in new if b".tmp" in name)
        if half:
            self.complain(step, kind, at, f"leaves {half[:3]} ({where})", errors)
        if status == undisturbed[0]:
            # Folders of runs are read as far as they can be, with a word about what cannot.
            is_told = kind == "open" and any(word in errors for word in (b"warning: ", b"cannot be read", b"are damaged"))
            if content(folder) != undisturbed[1] and not is_told:
                self.complain(step, kind, at, f"goes on with other results ({where})", errors)
            return
        wrong = [line for line in errors.splitlines() if line.startswith(b"error: ") or b": failed: " in line]
        if not wrong:
            self.complain(step, kind, at, f"fails and says nothing ({where})", errors)
        if new and step not in KEEPS_PARTS and status in (2, 3, 4) and not any(b"record.json" in name for name in new):
            self.complain(step, kind, at, f"leaves {sorted(new)[:3]} ({where})", errors)

    def power_cut(self, step):
        """Whether what is renamed to its final name was synced before, and its folder after: else a power cut leaves names of files
        without their bytes. Of folders of results; single pages and tables are renamed without, and are written again."""
        folder = self.fresh()
        _, _, log = self.command(folder, STEPS[step], "files", 0)
        unsynced, renames, waiting = set(), 0, set()
        for line in log:
            kind, path = line.split(" ", 1)
            if kind == "rename":
                source, target = (os.path.join(folder, name) for name in path.split(" -> "))
                if ".tmp" not in target and "/.fusebench/" not in target:  # what the engine keeps is written again
                    renames += 1
                    late = [name for name in unsynced if name.startswith(source + "/") or name == source]
                    if late:
                        self.complain(step, "power cut", renames, f"{late[:3]} are renamed before they are synced", b"")
                    waiting.add(os.path.dirname(os.path.normpath(target)))
                continue
            path = os.path.normpath(os.path.join(folder, path))
            if kind == "write":
                unsynced.add(path)
            elif kind == "sync":
                unsynced.discard(path)
                waiting.discard(path)
                if sum(other.startswith("sync") for other in log) < 5:  # of the whole file system
                    unsynced = {name for name in unsynced if not name.startswith(path)}
        if waiting:
            self.complain(step, "power cut", renames, f"the names in {waiting} are not synced", b"")
        print(f"| {step} | power cut | {len(log)} | {renames} | renamed after their bytes were synced |", flush=True)

    def step(self, step, kinds, limit):
        folder = self.fresh()
        status, errors, _ = self.command(folder, STEPS[step])
        if status != 0:
            raise SystemExit(f"faults: {step} ends with {status}: {errors.decode(errors='replace')}")
        undisturbed = (status, content(folder))
        rows = []
        for kind in kinds:
            _, _, log = self.command(self.fresh(), STEPS[step], kind, 0)
            calls = sum(line.startswith(kind) for line in log)
            most = min(limit, 200) if kind == "allocate" else limit
            places = range(1, calls + 1) if calls <= most else sorted({1 + (2 * k + 1) * calls // (2 * most) for k in range(most)})
            outcomes = {}
            for at in places:
                outcome = self.one(step, kind, at, undisturbed)
                if outcome is None:
                    outcome = "not reached"
                outcomes[outcome] = outcomes.get(outcome, 0) + 1
            rows.append((step, kind, calls, len(places), ", ".join(f"{count} {name}" for name, count in sorted(outcomes.items()))))
            if calls:
                print("| " + " | ".join(map(str, rows[-1])) + " |", flush=True)
        return rows


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("\n\n")[1], add_help=False)
    parser.add_argument("binary")
    parser.add_argument("--every", action="store_true")
    parser.add_argument("--sample", type=int, default=3)
    parser.add_argument("--only", choices=list(STEPS))
    parser.add_argument("--kind", choices=list(KINDS))
    options = parser.parse_args()
    room = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None  # syncs of a disk would take most of the time
    with tempfile.TemporaryDirectory(prefix="fusebench_faults_", dir=room) as scratch:
        faults = Faults(options.binary, scratch)
        print("| step | kind | calls | faults | outcomes |\n|---|---|---:|---:|---|", flush=True)
        total = 0
        for step in [options.only] if options.only else STEPS:
            rows = faults.step(step, [options.kind] if options.kind else KINDS, 10**9 if options.every else options.sample)
            total += sum(row[3] for row in rows)
            if step in SYNCED and not options.kind:
                faults.power_cut(step)
        print(f"faults: {total} faults in {1 if options.only else len(STEPS)} steps, {len(faults.failures)} of them not survived")
        return 1 if faults.failures else 0


if __name__ == "__main__":
    sys.exit(main())
