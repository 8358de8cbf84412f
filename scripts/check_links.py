#!/usr/bin/env python3
"""Finds dead links in the Markdown files of the repository: files that are not there, and anchors that no heading has.

Usage: scripts/check_links.py [ROOT]
       scripts/check_links.py --list FILE...    prints the files that these link to, without checking

Anchors are those that GitHub and MkDocs give headings. Links to other sites are not followed. Exit code: 0 none is dead, 1 one is,
2 usage.
"""

import pathlib
import re
import subprocess
import sys

HEADING = re.compile(r"^#{1,6}\s+(.*?)\s*#*\s*$")
LINK = re.compile(r"(?<!\\)\[(?:[^\[\]]|\[[^\]]*\])*\]\(\s*<?([^)\s>]+)>?(?:\s+\"[^\"]*\")?\s*\)")
ELSEWHERE = re.compile(r"^[a-z][a-z0-9+.-]*:", re.IGNORECASE)


def prose(text):
    """(line number, line) outside of code blocks."""
    fence = None
    before = ""
    inside_indented = False
    for number, line in enumerate(text.splitlines(), start=1):
        mark = re.match(r"\s*(`{3,}|~{3,})", line)
        if mark:
            if fence is None:
                fence = mark.group(1)
            elif line.strip().startswith(fence):
                fence = None
            before = line
            continue
        if fence is not None:
            continue
        # A paragraph that is indented by four is code; a list's further lines follow a line of text.
        inside_indented = line.startswith("    ") and (inside_indented or not before.strip())
        before = line
        if not inside_indented:
            yield number, line


def anchor(heading):
    """As GitHub makes it of a heading's text."""
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).replace("`", "")
    return re.sub(r"\s", "-", re.sub(r"[^\w\- ]", "", text.strip().lower()))


def anchors(text):
    """Those of a file; of equal headings the later ones have a number."""
    found = {}
    names = set()
    for _, line in prose(text):
        match = HEADING.match(line)
        if match:
            name = anchor(match.group(1))
            count = found.get(name, 0)
            found[name] = count + 1
            names.add(name if count == 0 else f"{name}-{count}")
    return names


def markdown_files(root):
    """Those that git has or would add; without git all."""
    try:
        listed = subprocess.run(["git", "-C", root, "ls-files", "-z", "--cached", "--others", "--exclude-standard", "*.md"],
                                check=True, capture_output=True).stdout.decode().split("\0")
        files = [root / name for name in listed if name]
    except (OSError, subprocess.CalledProcessError):
        files = root.rglob("*.md")
    return sorted(file for file in files if file.is_file())


def links_of(text):
    """(line number, target) of links that stay in the repository."""
    for number, line in prose(text):
        for target in LINK.findall(re.sub(r"`[^`]*`", lambda code: " " * len(code.group()), line)):
            if not ELSEWHERE.match(target):
                yield number, target


def print_targets(root, files):
    targets = set()
    for file in map(pathlib.Path, files):
        for _, target in links_of(file.read_text(encoding="utf-8")):
            path = target.partition("#")[0]
            there = (file.parent / path).resolve()
            if path and there.is_file():
                targets.add(str(there.relative_to(root)))
    print("\n".join(sorted(targets)))
    return 0


def check(root):
    texts = {file: file.read_text(encoding="utf-8") for file in markdown_files(root)}
    names = {file: anchors(text) for file, text in texts.items()}
    links, dead = 0, []
    for file, text in texts.items():
        for number, target in links_of(text):
            links += 1
            path, _, name = target.partition("#")
            there = (file.parent / path).resolve() if path else file
            where = f"{file.relative_to(root)}:{number}: {target}"
            if not there.exists():
                dead.append(f"{where}: there is no such file")
            elif not there.is_relative_to(root):
                dead.append(f"{where}: outside of the repository")
            elif name and there in names and name not in names[there]:
                dead.append(f"{where}: no heading of {there.relative_to(root)} has this anchor")
    for line in dead:
        print(line, file=sys.stderr)
    print(f"{links} links in {len(texts)} files, {len(dead)} dead")
    return 1 if dead else 0


def main(arguments):
    root = pathlib.Path(__file__).resolve().parent.parent
    if arguments[:1] == ["--list"]:
        return print_targets(root, arguments[1:])
    if len(arguments) > 1 or (arguments and arguments[0].startswith("-")):
        wanted = arguments[0] in ("-h", "--help")
        print(__doc__.strip(), file=sys.stdout if wanted else sys.stderr)
        return 0 if wanted else 2
    return check(pathlib.Path(arguments[0]).resolve() if arguments else root)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
