#!/usr/bin/env python3
"""Runs the commands of docs/tutorial.md again, and writes what they print, and the pictures that they make, into it.

Usage: scripts/generate_tutorial.py [--keep FOLDER] [BINARY]

BINARY (default: build/release/fusebench) is the program that the page calls fusebench. The commands run in order in one folder, a temporary
one or FOLDER. It takes some minutes; pages are photographed by chromium, and figures are drawn by gnuplot, which have to be
installed. What is done is written in the page itself:
  ```console                        lines "$ COMMAND" are run, the lines after them are replaced by what it prints; a command goes
                                    on after a \\ at a line's end. "$ COMMAND  # fails: N" has to end with exit code N
  <!-- file NAME -->                the code block after it is written to the file NAME
  <!-- screen PAGE WIDTHxHEIGHT --> the picture after it, tutorial/NAME.png, is the upper part of that page
  ![...](tutorial/NAME)             any other picture is the file tutorial/NAME that a command has written
Exit code: 0, 1 if a command does not end as it should, 2 usage.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "tutorial.md"
MOST_LINES = 24
WIDEST = 150


def printed(text):
    """Lines as the page shows them: few, and not too long."""
    progress = "... "  # begins the lines of long work, whose times differ
    lines = [line.rstrip() for line in text.splitlines() if not line.startswith(progress)]
    while lines and not lines[-1]:
        lines.pop()
    if len(lines) > MOST_LINES:
        lines = lines[:MOST_LINES - 4] + [f"... ({len(lines) - MOST_LINES + 4} more lines)"]
    return [line if len(line) <= WIDEST else line[:WIDEST - 3] + "..." for line in lines]


class Tutorial:
    def __init__(self, binary, folder):
        self.folder = folder
        programs = folder / ".programs"
        programs.mkdir(parents=True, exist_ok=True)
        (programs / "fusebench").unlink(missing_ok=True)
        (programs / "fusebench").symlink_to(binary)
        (folder / "tutorial").mkdir(exist_ok=True)
        self.environment = dict(os.environ, PATH=f"{programs}:{os.environ['PATH']}", LC_ALL="C.UTF-8")
        self.environment.pop("FUSEBENCH_DATA", None)

    def run(self, command):
        match = re.search(r"\s+# fails: (\d+)$", command)
        wanted = int(match.group(1)) if match else 0
        print("$ " + command, file=sys.stderr)
        done = subprocess.run(["bash", "-c", command], cwd=self.folder, env=self.environment, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if done.returncode != wanted:
            sys.exit(f"generate_tutorial: exit code {done.returncode}, not {wanted}, of: {command}\n{done.stdout}")
        return printed(done.stdout.replace(f"{self.folder}/", ""))

    def console(self, lines):
        """The block again, with what its commands print now."""
        result, command = [], None
        for line in lines:
            if command is not None:
                command += "\n" + line
            elif line.startswith("$ "):
                command = line[2:]
            else:
                continue  # what it printed before
            result.append(line)
            if not command.endswith("\\"):
                result += self.run(command)
                command = None
        return result

    def screen(self, page, size, picture):
        width, height = size.split("x")
        file = self.folder / "tutorial" / picture
        subprocess.run(["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars",
                        "--virtual-time-budget=10000", f"--window-size={width},{height}", f"--screenshot={file}",
                        (self.folder / page).as_uri()], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def page(self, text):
        result, lines = [], iter(text.splitlines())
        file, screen, pictures = None, None, []
        for line in lines:
            result.append(line)
            if match := re.fullmatch(r"<!-- file (\S+) -->", line):
                file = match.group(1)
            elif match := re.fullmatch(r"<!-- screen (\S+) (\d+x\d+) -->", line):
                screen = match.groups()
            elif match := re.fullmatch(r"!\[.*\]\(tutorial/([^/)]+)\)", line):
                if screen:
                    self.screen(*screen, match.group(1))
                    screen = None
                pictures.append(match.group(1))
            elif line.startswith("```"):
                block = []
                for inner in lines:
                    if inner == "```":
                        break
                    block.append(inner)
                if file:
                    (self.folder / file).write_text("\n".join(block) + "\n", encoding="utf-8")
                    file = None
                elif line == "```console":
                    block = self.console(block)
                result += block + ["```"]
        return "\n".join(result) + "\n", pictures


def main(arguments):
    keep = None
    if arguments[:1] == ["--keep"] and len(arguments) > 1:
        keep, arguments = pathlib.Path(arguments[1]).resolve(), arguments[2:]
    if len(arguments) > 1 or (arguments and arguments[0].startswith("-")):
        wanted = arguments[0] in ("-h", "--help")
        print(__doc__.strip(), file=sys.stdout if wanted else sys.stderr)
        return 0 if wanted else 2
    binary = pathlib.Path(arguments[0] if arguments else ROOT / "build/release/fusebench").resolve()
    if not binary.exists():
        print(f"generate_tutorial: there is no binary {binary}; build it first (scripts/build.sh)", file=sys.stderr)
        return 2
    with tempfile.TemporaryDirectory() as temporary:
        folder = keep or pathlib.Path(temporary) / "work"
        folder.mkdir(parents=True, exist_ok=True)
        tutorial = Tutorial(binary, folder)
        text, pictures = tutorial.page(PAGE.read_text(encoding="utf-8"))
        there = PAGE.parent / "tutorial"
        shutil.rmtree(there, ignore_errors=True)
        there.mkdir()
        for picture in pictures:
            shutil.copyfile(folder / "tutorial" / picture, there / picture)
        PAGE.write_text(text, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
