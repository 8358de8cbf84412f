#!/usr/bin/env python3
"""Long work shows on standard error what it does, and a signal ends it.

Usage: tests/cli/progress_test.py BINARY
"""
import os
import pty
import re
import signal
import subprocess
import sys
import tempfile
import time

LIMIT_S = 120  # of a busy machine; the first line is due after 5 s
SIMULATION = ["--duration", "120", "--rate", "30", "--size", "640x480"]
SUITE = """name = "long"
variants = ["no-imu"]
[[simulations]]
name = "long"
format = "tum"
preset = "slow"
seed = 1
duration_s = 120
size = "640x480"
"""
LINE = re.compile(rb"\.\.\. (.+) \((\d+) s\)\n")


def read_until(descriptor, pattern):
    """What is read up to the pattern, or to the end of the time or the file."""
    text = b""
    end = time.monotonic() + LIMIT_S
    while time.monotonic() < end and not pattern.search(text):
        try:
            part = os.read(descriptor, 4096)
        except OSError:  # a terminal whose program has ended
            break
        if not part:
            break
        text += part
    return text


def stopped(process):
    process.send_signal(signal.SIGINT)
    return process.wait(timeout=LIMIT_S)


def lines_of_pipe(command, count):
    """The first lines of progress, and the exit code after SIGINT."""
    process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    text = read_until(process.stderr.fileno(), re.compile(rb"(?:(?s:.*?)\.\.\. [^\n]+\n){%d}" % count))
    code = stopped(process)
    return text, LINE.findall(text), code


def check_pipe(name, command, expected):
    text, lines, code = lines_of_pipe(command, 2)
    failures = []
    if len(lines) < 2:
        failures.append(f"{name}: no two lines of progress in {text!r}")
    elif not re.search(expected, lines[1][0]):
        failures.append(f"{name}: {lines[1][0]!r} does not match {expected!r}")
    elif int(lines[1][1]) - int(lines[0][1]) < 4 and lines[0][0].split(b":")[0] == lines[1][0].split(b":")[0]:
        failures.append(f"{name}: more than one line in 5 s: {lines!r}")
    if b"\033" in text or b"\r" in text:
        failures.append(f"{name}: control characters in {text!r}")
    if code != 130:
        failures.append(f"{name}: exit code {code} after SIGINT")
    return failures


def check_terminal(name, command):
    """On a terminal one line is redrawn."""
    mine, theirs = pty.openpty()
    process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=theirs)
    os.close(theirs)
    text = read_until(mine, re.compile(rb"(?:(?s:.*?)\r\033\[K[^\r\n]*\d+/\d+){3}"))
    code = stopped(process)
    os.close(mine)
    failures = [] if text.count(b"\r\033[K") >= 3 else [f"{name}: the line is not redrawn: {text!r}"]
    if b"\n" in text:
        failures.append(f"{name}: more than one line: {text!r}")
    return failures if code == 130 else failures + [f"{name}: exit code {code} after SIGINT"]


def main():
    if len(sys.argv) != 2 or sys.argv[1] in ("-h", "--help"):
        print(__doc__.strip(), file=sys.stderr)
        return 2
    binary = os.path.abspath(sys.argv[1])
    os.environ.pop("FUSEBENCH_DATA", None)
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        with open("suite.toml", "w", encoding="utf-8") as file:
            file.write(SUITE)
        simulate = [binary, "simulate", "--out", "out/a", *SIMULATION]
        failures = check_pipe("simulate", simulate, rb"^simulating out/a: \d+/\d+$")
        failures += check_terminal("simulate", simulate)
        failures += check_pipe("bench", [binary, "bench", "suite.toml", "--out", "runs"], rb"simulating long: \d+/\d+$")
        failures += check_pipe("reproduce", [binary, "reproduce", "figures", "--out", "runs", "--figures", "figures"],
                               rb"^\[1/\d+\] simulating ")
    for failure in failures:
        print("FAILED: " + failure, file=sys.stderr)
    print(f"progress: {len(failures)} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
