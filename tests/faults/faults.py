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
import signal
import sys

from steps import KEEPS_PARTS, STEPS, StepRunner, content, scratch_folder

import oracle

KINDS = {"write": errno.ENOSPC, "sync": errno.EIO, "rename": errno.EIO, "create": errno.ENOSPC, "open": errno.EMFILE,
         "map": errno.ENOMEM, "fork": errno.EAGAIN, "allocate": errno.ENOMEM}


class Faults(StepRunner):
    def __init__(self, binary, scratch):
        super().__init__(binary, scratch, ["libfusebench_failing_calls.so"])
        self.failures = []

    def command_with_fault(self, step, kind, at):
        """(exit code, standard error, lines of the log). at: 0 lists the calls of all kinds."""
        log = self.scratch / "log"
        log.unlink(missing_ok=True)
        settings = [f"FAULTS_KIND={kind}", f"FAULTS_AT={at}", f"FAULTS_ERROR={KINDS[kind]}", f"FAULTS_LOG={log}"]
        status, errors, _ = self.command(STEPS[step], settings)
        return status, errors, log.read_text(errors="replace").splitlines() if log.exists() else []

    def complain(self, step, kind, at, what, errors):
        self.failures.append(f"{step}, {kind} {at}: {what}")
        print(f"FAILED: {self.failures[-1]}\n    {errors[-400:].decode(errors='replace').strip()}", flush=True)

    def one(self, step, kind, at, undisturbed):
        """The outcome of one fault: a word; None if that many calls are not made."""
        folder = self.fresh()
        before = oracle.listing(folder)
        status, errors, log = self.command_with_fault(step, kind, at)
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
        wrong, said = self.second_try(step, undisturbed)
        if wrong:
            self.complain(step, kind, at, wrong, said)
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

    def step(self, step, kinds, limit):
        undisturbed = self.undisturbed(step)
        self.fresh()
        _, _, log = self.command_with_fault(step, "write", 0)
        rows = []
        for kind in kinds:
            calls = sum(line.startswith(kind + " ") for line in log)
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
    with scratch_folder() as scratch:
        faults = Faults(options.binary, scratch)
        print("| step | kind | calls | faults | outcomes |\n|---|---|---:|---:|---|", flush=True)
        total = 0
        for step in [options.only] if options.only else STEPS:
            rows = faults.step(step, [options.kind] if options.kind else KINDS, 10**9 if options.every else options.sample)
            total += sum(row[3] for row in rows)
        faults.served.close()
        print(f"faults: {total} faults in {1 if options.only else len(STEPS)} steps, {len(faults.failures)} of them not survived")
        return 1 if faults.failures else 0


if __name__ == "__main__":
    sys.exit(main())
