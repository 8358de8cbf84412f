#!/usr/bin/env python3
"""Lists text that is hard to read, and fails on terms that the project does not use.

Usage: scripts/check_words.py [FILE|FOLDER]...           lists candidates: forbidden terms, personified software, fragments
       scripts/check_words.py --check [FILE|FOLDER]...   lists forbidden terms alone

Without arguments, reads the files that differ from the branch main, or with --check core, datasets, eval, docs and README.md. Reads
comments and string literals of C++ and Python, and all text of Markdown. Exit code: 0 no forbidden term, 1 a forbidden term (--check
only), 2 usage.
"""

import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
CHECKED = ["core", "datasets", "eval", "docs", "README.md"]
SUFFIXES = {".hpp", ".cpp", ".py", ".md"}

# Forbidden term: what to write instead. Keys of files and options (untold_time_offset_s) are no words of a text.
FORBIDDEN = {
    r"undone": "compensated (read-out) or reversed (filter)",
    r"untold(?![_\-\]])": "not given, not observable",
    r"(?:not )?believed?s?": "accepted, rejected",
    r"rival(?:s| places?)?": "ambiguous candidate",
    r"found frames?": "relocalised frame",
    r"mended": "fixed",
    r"tracker's word": "self-relocalisation edge",
    r"pending revisits?": "deferred fusion",
    r"(?<!ground )(?<!ground-)the truth(?!s? table)": "the ground truth",
    r"(?:is|are|was|were|be) (?:looked at|asked for)": "is checked, is requested",
    r"(?:stands?|lies|lie|laid) beside": "is next to, is stored in",
    r"two worlds": "odometry frame and map frame",
}
SUBJECT = (r"(?:it|which|code|program|filter|tracker|estimator|system|reader|parser|function|class|file|frame|image|model|patch(?:es)?"
           r"|library|engine|command|option|table|page|test|script)")
ACT = r"(?:knows?|wants?|asks?|tells?|told|says?|said|trusts?|looks? (?:at|for)|thinks?|learns?|refuses?)"
PERSONIFIED = re.compile(rf"\b{SUBJECT} {ACT}\b", re.IGNORECASE)
FRAGMENT = re.compile(r"(?:Of|The same(?! \w+ gives)|That of|Those|One that|These two|What|Whether|How|By (?:how|what|which))\b")
CPP_TEXT = re.compile(r'//[/!]?<?(?P<comment>.*)$|"(?P<string>(?:[^"\\]|\\.)*)"')
FORBIDDEN_PATTERN = re.compile("|".join(rf"\b(?P<t{i}>{term})(?!\w)" for i, term in enumerate(FORBIDDEN)), re.IGNORECASE)


def texts(path):
    """(line number, text, True for a comment of its own) of what a reader of the file reads."""
    for number, line in enumerate(path.read_text(encoding="utf-8", errors="replace").splitlines(), start=1):
        if path.suffix == ".md":
            yield number, re.sub(r"`[^`]*`|\]\([^)]*\)", " ", line), False
        elif path.suffix == ".py":
            code, mark, comment = line.partition("#")
            for text in [comment, *re.findall(r'"((?:[^"\\]|\\.)*)"', code)]:
                yield number, text, bool(mark) and not code.strip()
        elif not line.startswith("#include"):
            for match in CPP_TEXT.finditer(line):
                own = match["comment"] is not None and not line[:match.start()].strip()
                yield number, match["comment"] or match["string"] or "", own


def candidates(path):
    """(line number, complaint) for the judgement of an author."""
    paragraph, first = "", 0
    for number, text, own in [*texts(path), (0, "", False)]:
        if match := PERSONIFIED.search(text):
            yield number, f'"{match[0]}": software reads, returns, reports, requires'
        if own and text.strip():
            first = first if paragraph else number
            paragraph += " " + text.strip()
            continue
        for sentence in re.split(r"(?<=[.:;])\s", paragraph.strip()):
            if FRAGMENT.match(sentence):
                yield first, f'fragment: "{sentence}"'
            if len(sentence.split()) > 35:
                yield first, f"{len(sentence.split())} words in a sentence"
        paragraph = ""


def forbidden(path):
    for number, text, _ in texts(path):
        for match in FORBIDDEN_PATTERN.finditer(text):
            term = list(FORBIDDEN.values())[int(match.lastgroup[1:])]
            yield number, f'forbidden term "{match[0]}": write {term}'


def files_of(names):
    for path in map(pathlib.Path, names):
        if not path.exists():
            print(f"check_words: {path}: there is no such file or folder", file=sys.stderr)
            sys.exit(2)
        yield from sorted(f for f in path.rglob("*") if f.suffix in SUFFIXES and f.is_file()) if path.is_dir() else [path]


def changed_files():
    command = ["git", "-C", str(ROOT), "diff", "--name-only", "--diff-filter=d", "main"]
    names = subprocess.run(command, capture_output=True, text=True, check=True).stdout.split()
    return [str(ROOT / name) for name in names if pathlib.Path(name).suffix in SUFFIXES]


def main(arguments):
    check = "--check" in arguments
    names = [argument for argument in arguments if argument != "--check"]
    if any(name.startswith("-") for name in names):
        print(__doc__.strip())
        return 0 if names[0] in ("-h", "--help") else 2
    if not names:
        names = [str(ROOT / name) for name in CHECKED] if check else changed_files()
    found = 0
    paths = list(files_of(names))
    for path in paths:
        complaints = [*forbidden(path), *([] if check else candidates(path))]
        for number, complaint in sorted(complaints):
            print(f"{path}:{number}: {complaint}")
        found += len(complaints)
    print(f"words: {len(paths)} files, {found} {'forbidden terms' if check else 'candidates'}")
    return int(check and found > 0)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
