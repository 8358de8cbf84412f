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
import collections
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
# Of a step, under final names.
LEFT = ("nothing", "some of its runs", "neither the old run nor the new one", "empty or zeros", "all")

# tree: of the disk; finished: places; whole: the tree after the step
Cut = collections.namedtuple("Cut", "step variant text tree finished whole")


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

    def __init__(self, root, places):
        self.root = root
        self.places = set(places)
        self.renamed = {}  # {process: what it may still be syncing}

    def take(self, record):
        if record.kind not in ("sync", "rename"):
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
        self.before = tree_of(self.inputs)
        self.failures = {}  # {(step, variant, what): how often}

    def complain(self, cut, what, errors=b""):
        key = (cut.step, cut.variant, what)
        self.failures[key] = self.failures.get(key, 0) + 1
        if self.failures[key] == 1:
            print(f"FAILED: {cut.step}, {cut.variant}, call {cut.text}: {what}", flush=True)
            if errors:
                print(f"    {errors[-400:].decode(errors='replace').strip()}", flush=True)

    def recorded(self, step):
        """The records of an undisturbed step, and the folder that they lead to."""
        log = self.scratch / "log"
        log.unlink(missing_ok=True)
        self.fresh()
        environment = {name: value for name, value in os.environ.items() if not name.startswith("FUSEBENCH")}
        environment.update(LD_PRELOAD=str(self.library), RECORD_FOLDER=str(self.work), RECORD_LOG=str(log))
        self.program(*STEPS[step], cwd=self.work, env=environment)
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
        undisturbed = self.undisturbed(step)
        records, whole = self.recorded(step)
        calls = len(records)
        at = range(1, calls + 1) if calls <= limit else sorted({1 + (2 * k + 1) * calls // (2 * limit) for k in range(limit)})
        disk, finished, tried, left = self.fresh_disk(), Finished(self.work, runs_of(self.before, "runs")), set(), {}
        for number, record in enumerate(records, 1):
            disk.apply(record)
            finished.take(record)
            for variant in VARIANTS if number in at else ():
                text = f"{number} of {calls} ({record.kind} {os.path.relpath(record.path, self.work)})"
                cut = Cut(step, variant, text, disk.tree(variant), frozenset(finished.places), whole)
                self.check_finished(cut)
                key = hashlib.sha256(repr((sorted(cut.tree.items()), sorted(cut.finished))).encode()).digest()
                if key not in tried:
                    tried.add(key)
                    what = self.try_disk(cut, undisturbed)
                    left[what] = left.get(what, 0) + 1
        cuts = len(at) * len(VARIANTS)
        outcomes = ", ".join(f"{left[what]} {what}" for what in LEFT if what in left)
        print(f"| {step} | {calls} | {cuts} | {len(tried)} | {outcomes} | {self.failed(step)} |", flush=True)
        return cuts, len(tried)

    def failed(self, step):
        """How often which promise was not kept."""
        return sum(count for (of, _, _), count in self.failures.items() if of == step)

    def is_whole(self, cut, place):
        """As the step has made it, or as it was before."""
        return below(cut.tree, place) in (below(cut.whole, place), below(self.before, place)) and bool(below(cut.tree, place))

    def check_finished(self, cut):
        for place in sorted(cut.finished):
            if not self.is_whole(cut, place):
                self.complain(cut, f"{place} was finished and is {'not whole' if below(cut.tree, place) else 'not there'}")

    def try_disk(self, cut, undisturbed):
        """What is left of the step, in words."""
        shutil.rmtree(self.work)
        write_tree(self.work, cut.tree, self.inputs)
        left = self.left_of_step(undisturbed)
        roots = [root for root in FOLDERS_OF_RUNS if runs_of(cut.whole, root)]
        for root in roots:
            self.check_counted(cut, root)
        wrong, said = self.second_try(cut.step, undisturbed)
        if wrong:
            self.complain(cut, wrong, said)
        after = tree_of(self.work)
        for place in sorted(cut.finished) if cut.step in KEEPS_PARTS else ():
            if self.is_whole(cut, place) and below(after, place) != below(cut.tree, place):
                self.complain(cut, f"{place} was finished and is run again", said)
        different = sorted(name for name, data in invocations(cut.whole).items() if after.get(name) != data)
        if different:
            self.complain(cut, f"after the second try {different} are not what the engine keeps for `rerun`")
        for root in roots:
            self.check_gc(cut, root)
        return left

    def left_of_step(self, undisturbed):
        now = {name: value for name, value in content(self.work).items() if not is_temporary(name)}
        if now == undisturbed[1]:
            return "all"
        before = content(self.inputs)
        if now == before:
            return "nothing"
        if not all(value in (before.get(name), undisturbed[1].get(name)) for name, value in now.items()):
            return "empty or zeros"
        return "some of its runs" if set(before) <= set(now) else "neither the old run nor the new one"

    def check_counted(self, cut, root):
        """Before the second try: what the program takes for results."""
        runs = runs_of(cut.tree, root)
        code, said, output = self.command(["list", "runs", root, "--json"])
        if code != (0 if runs else 3):
            self.complain(cut, f"`list runs {root}` of {len(runs)} runs ends with {code}", said)
            return
        rows = json.loads(output)["runs"] if code == 0 else []
        for row in rows:
            is_whole = self.is_whole(cut, row["run"])
            if (row["status"] == "ok") != is_whole or not (is_whole or row["reason"]):
                self.complain(cut, f"{row['run']}, {'whole' if is_whole else 'not whole'}, is listed as {row['status']} ({row['reason']})")
        if sorted(row["run"] for row in rows) != runs:
            self.complain(cut, f"{len(runs)} runs, of which {len(rows)} are listed")
        good = sum(row["status"] == "ok" for row in rows)
        code, said, output = self.command(["table", root])
        if code != (0 if runs else 3) or (runs and f"{good} of {len(runs)} runs ok".encode() not in output):
            self.complain(cut, f"`table {root}` of {good} good runs and {len(runs)} in all ends with {code}", said)

    def check_gc(self, cut, root):
        """After the second try. (Hidden files, of tables and pages, stay: nobody can tell whether they are still written.)"""
        code, said, _ = self.command(["gc", root])
        tree = tree_of(self.work)
        left = [name for name, data in below(tree, root).items() if data is None and is_temporary(name)]
        if code != 0 or left:
            self.complain(cut, f"gc ends with {code} and leaves {left[:3]}", said)


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("\n\n")[1], add_help=False)
    parser.add_argument("binary")
    parser.add_argument("--every", action="store_true")
    parser.add_argument("--sample", type=int, default=3)
    parser.add_argument("--only", choices=list(STEPS))
    options = parser.parse_args()
    with scratch_folder() as scratch:
        cuts = PowerCuts(options.binary, scratch)
        print("| step | calls | cuts | disks | of the step is left | not kept |\n|---|---:|---:|---:|---|---:|", flush=True)
        total = [cuts.step(step, 10**9 if options.every else options.sample) for step in ([options.only] if options.only else STEPS)]
        cuts.served.close()
        print(f"power cuts: {sum(n for n, _ in total)} cuts, {sum(n for _, n in total)} different disks in {len(total)} steps, "
              f"{sum(cuts.failures.values())} promises not kept")
        return 1 if cuts.failures else 0


if __name__ == "__main__":
    sys.exit(main())
