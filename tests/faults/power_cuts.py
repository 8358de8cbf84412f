#!/usr/bin/env python3
"""Cuts the power after the n-th call that changes the disk, for every n, and checks what is left and that the same command goes on.

Usage: tests/faults/power_cuts.py BINARY [--every | --sample N] [--only STEP]

Each step is recorded once, in order (recorded_calls.cpp). For every cut the folder is built as a disk may hold it then, in two
variants (recorded_disk.py): `late`, only what was synced is there, and `early`, all names and sizes are there, and zeros for content
that was not synced. --sample N (default 3): at most N cuts of each step, spread over all calls; --every: all. Of each disk:
- what was finished before the cut, a folder or file that was synced and has got its final name, is there with all its bytes;
- `table` and `list runs` count as good what is whole, and nothing else: other runs are rows with a reason, or not there;
- the same command ends with the exit code and the bytes of an undisturbed one (but for times), runs no finished run again, and leaves
  nothing new under a temporary name; what the cut left under one in a folder of runs, `gc` removes.
Single tables and pages are renamed without being synced: for them only the last is promised.

Not modelled: parts of a write, one name of a folder without another, writes of the disk that were acknowledged and lost, and other
processes than the program's. Disks that are alike are tried once. Prints a table: step, calls, cuts, disks, what is left on them.
Exit code: 0 all kept, 1 not, 2 usage.
"""

import argparse
import hashlib
import json
import os
import shutil
import sys

from recorded_disk import Disk, read_records, tree_of, write_tree
from steps import KEEPS_PARTS, STEPS, StepRunner, content, is_temporary, scratch_folder

import server

FOLDERS_OF_RUNS = ("out", "runs")
VARIANTS = ("late", "early")


def below(tree, place):
    """What a tree holds of a file, or of a folder and all in it."""
    return {name: data for name, data in tree.items() if name == place or name.startswith(place + "/")}


def runs_of(tree, root):
    """Folders with a record below a root, without the engine's and temporary ones."""
    names = [name for name in below(tree, root) if name.endswith("/record.json")]
    return sorted(os.path.dirname(name) for name in names if not is_temporary(name) and "/.fusebench/" not in name)


def invocations(tree):
    """What the engine keeps, for `rerun`."""
    return {name: data for name, data in tree.items() if "/.fusebench/invocations/" in name and not is_temporary(name)}


class Finished:
    """The files and folders that a process has synced under a temporary name, renamed to their final one, and gone on from."""

    def __init__(self, root):
        self.root = root
        self.places = set()
        self.renamed = {}  # {process: what it may still be syncing}

    def take(self, record):
        if record.kind != "sync":
            self.places.update(self.renamed.pop(record.process, ()))
        if record.kind != "rename":
            return
        source, target = (os.path.relpath(path, self.root) for path in (record.path, record.other))
        self.places.discard(source)
        if is_temporary(os.path.dirname(source)) and not is_temporary(target):
            self.renamed.setdefault(record.process, []).append(target)


class PowerCuts(StepRunner):
    def __init__(self, binary, scratch):
        super().__init__(binary, scratch)
        self.library = server.find_library(self.binary, "libfusebench_recorded_calls.so")
        self.failures = []

    def complain(self, where, what, errors=b""):
        self.failures.append(f"{where}: {what}")
        print(f"FAILED: {self.failures[-1]}\n    {errors[-400:].decode(errors='replace').strip()}", flush=True)

    def recorded(self, step):
        """The records of an undisturbed step, and the folder that they lead to."""
        log = self.scratch / "log"
        log.unlink(missing_ok=True)
        self.fresh()
        status, errors, _ = self.command(STEPS[step], self.library, {"RECORD_FOLDER": str(self.work), "RECORD_LOG": str(log)})
        if status != 0:
            raise SystemExit(f"faults: {step} ends with {status} while it is recorded: {errors.decode(errors='replace')}")
        tree = tree_of(self.work)
        records = read_records(log)
        disk = self.fresh_disk()
        records = [record for record in records if disk.apply(record)]
        replayed = disk.tree("live")
        if replayed != tree:
            different = sorted(name for name in set(tree) | set(replayed) if tree.get(name, 0) != replayed.get(name, 0))
            raise SystemExit(f"faults: the calls of {step} that were recorded do not make {different[:5]}")
        return records, tree

    def fresh_disk(self):
        """As before the step; the names of the records are those of the folder of work."""
        disk = Disk(self.inputs)
        disk.root = str(self.work)
        return disk

    def step(self, step, limit):
        undisturbed = (0, content(self.fresh_after(step)))
        records, whole = self.recorded(step)
        calls = len(records)
        cuts = range(1, calls + 1) if calls <= limit else sorted({1 + (2 * k + 1) * calls // (2 * limit) for k in range(limit)})
        disk, finished, tried, left = self.fresh_disk(), Finished(self.work), set(), {}
        for number, record in enumerate(records, 1):
            disk.apply(record)
            finished.take(record)
            for variant in VARIANTS if number in cuts else ():
                tree = disk.tree(variant)
                where = f"{step}, {variant} after call {number} of {calls} ({record.kind} {os.path.relpath(record.path, self.work)})"
                self.check_finished(where, tree, finished.places, whole)
                key = hashlib.sha256(repr(sorted(tree.items())).encode() + repr(sorted(finished.places)).encode()).digest()
                if key not in tried:
                    tried.add(key)
                    what = self.try_disk(where, step, tree, (finished.places, whole), undisturbed)
                    left[what] = left.get(what, 0) + 1
        print(f"| {step} | {calls} | {len(cuts) * len(VARIANTS)} | {len(tried)} | "
              + ", ".join(f"{count} {what}" for what, count in sorted(left.items())) + " |", flush=True)
        return len(cuts) * len(VARIANTS), len(tried)

    def fresh_after(self, step):
        self.undisturbed(step)
        return self.work

    def check_finished(self, where, tree, places, whole):
        for place in sorted(places):
            if below(tree, place) != below(whole, place):
                self.complain(where, f"{place} was finished and is {'not whole' if below(tree, place) else 'not there'}")

    def try_disk(self, where, step, tree, finished, undisturbed):
        """What is left of the step on a disk, in words."""
        places, whole = finished
        shutil.rmtree(self.work)
        write_tree(self.work, tree)
        left = self.left_of_step(undisturbed)
        roots = [root for root in FOLDERS_OF_RUNS if runs_of(whole, root)]
        for root in roots:
            self.check_counted(where, root, tree, whole)
        wrong, said = self.second_try(step, undisturbed)
        if wrong:
            self.complain(where, wrong, said)
        after = tree_of(self.work)
        for place in sorted(places):
            is_kept = below(tree, place) == below(whole, place)
            if step in KEEPS_PARTS and is_kept and below(after, place) != below(whole, place):
                self.complain(where, f"{place} was finished and is run again", said)
        if invocations(after) != invocations(whole):
            different = sorted(name for name, data in invocations(whole).items() if invocations(after).get(name) != data)
            self.complain(where, f"after the second try, {different[:2]} are not what the engine keeps for `rerun`")
        for root in roots:
            self.check_gc(where, root)
        return left

    def left_of_step(self, undisturbed):
        now = {name: value for name, value in content(self.work).items() if not is_temporary(name)}
        if now == undisturbed[1]:
            return "all"
        return "none" if all((self.inputs / name).exists() for name in now) else "a part"

    def check_counted(self, where, root, tree, whole):
        """Before the second try: what the program takes for results."""
        runs = runs_of(tree, root)
        code, said, output = self.command(["list", "runs", root, "--json"])
        if code != (0 if runs else 3):
            self.complain(where, f"`list runs {root}` of {len(runs)} runs ends with {code}", said)
            return
        rows = json.loads(output) if runs else []
        good = [row["run"] for row in rows if row["status"] == "ok"]
        for row in rows:
            is_whole = below(tree, row["run"]) == below(whole, row["run"])
            if (row["status"] == "ok") != is_whole or not (is_whole or row["reason"]):
                self.complain(where, f"{row['run']}, {'whole' if is_whole else 'not whole'}, is listed as {row['status']} ({row['reason']})")
        if sorted(row["run"] for row in rows) != runs:
            self.complain(where, f"{len(runs)} runs, of which {len(rows)} are listed")
        code, said, output = self.command(["table", root])
        if code != (0 if runs else 3) or (runs and f"{len(good)} of {len(runs)} runs ok".encode() not in output):
            self.complain(where, f"`table {root}` of {len(good)} good runs and {len(runs)} in all ends with {code}", said)

    def check_gc(self, where, root):
        code, said, _ = self.command(["gc", root])
        left = [name for name in below(tree_of(self.work), root) if is_temporary(name)]
        if code != 0 or left:
            self.complain(where, f"gc ends with {code} and leaves {left[:3]}", said)


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("\n\n")[1], add_help=False)
    parser.add_argument("binary")
    parser.add_argument("--every", action="store_true")
    parser.add_argument("--sample", type=int, default=3)
    parser.add_argument("--only", choices=list(STEPS))
    options = parser.parse_args()
    with scratch_folder() as scratch:
        cuts = PowerCuts(options.binary, scratch)
        print("| step | calls | cuts | disks | of the step is left |\n|---|---:|---:|---:|---|", flush=True)
        total = [cuts.step(step, 10**9 if options.every else options.sample) for step in ([options.only] if options.only else STEPS)]
        print(f"power cuts: {sum(n for n, _ in total)} cuts, {sum(n for _, n in total)} different disks in {len(total)} steps, "
              f"{len(cuts.failures)} promises not kept")
        return 1 if cuts.failures else 0


if __name__ == "__main__":
    sys.exit(main())
