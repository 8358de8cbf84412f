#!/usr/bin/env python3
"""Every command, option and page that a message of the program names exists.

Usage: tests/cli/hints_test.py BINARY REPOSITORY
"""
import functools
import os
import re
import subprocess
import sys

LITERAL = re.compile(r'"((?:[^"\\\n]|\\.)*)"')
# Options of other programs, which messages and documents of exports name.
FOREIGN = {"--integrate", "--make", "--refine", "--register", "--dst", "--src", "--partition"}
OF_OTHER_PROGRAMS = {"slurm_commands.cpp", "evo_spelling.cpp"}
# A word behind a verb that is no word of the command line.
PLACEHOLDER = re.compile(r"[A-Z{<].*|\.\.\.")


def without_comments(text):
    """C++ without comments; string literals stay."""
    return re.sub(r'"(?:[^"\\\n]|\\.)*"|//[^\n]*|/\*.*?\*/', lambda m: m.group() if m.group()[0] == '"' else " ", text,
                  flags=re.DOTALL)


def sentences(path):
    """The string literals of a source; adjacent ones as one, with the line of the first."""
    with open(path, encoding="utf-8") as file:
        text = file.read()
    raw = re.sub(r'R"(\w*)\(.*?\)\1"', lambda m: '"' + " " * 0 + '"' + "\n" * m.group().count("\n"), text, flags=re.DOTALL)
    raw = without_comments(re.sub(r'^\s*#include.*$', "", raw, flags=re.MULTILINE))
    end, said, line = 0, None, 0
    for match in LITERAL.finditer(raw):
        if said is not None and not raw[end:match.start()].strip():
            said += match.group(1)
        else:
            if said is not None:
                yield line, said
            said, line = match.group(1), raw.count("\n", 0, match.start()) + 1
        end = match.end()
    if said is not None:
        yield line, said


class Program:
    def __init__(self, binary):
        self.binary = binary

    @functools.lru_cache(maxsize=None)
    def help(self, verb):
        done = subprocess.run([self.binary, *verb, "--help"], capture_output=True, text=True, check=False)
        return done.stdout if done.returncode == 0 else ""

    @functools.lru_cache(maxsize=None)
    def verbs(self, above=()):
        listed = re.search(r"^Subcommands:\n((?:  .*\n|    .*\n)+)", self.help(above), re.MULTILINE)
        names = re.findall(r"^  ([\w-]+)", listed.group(1), re.MULTILINE) if listed else []
        if above == ("eval",):
            names.append("ape")
        return frozenset(names)

    @functools.lru_cache(maxsize=None)
    def options(self, verb):
        return frozenset(re.findall(r"(?<![\w-])(-{1,2}[a-zA-Z][\w-]*)", self.help(verb))) | {"--help", "-h"}

    @functools.lru_cache(maxsize=None)
    def all_options(self):
        found = set(self.options(())) | {"--version"}
        for verb in self.verbs():
            found |= self.options((verb,))
            for inner in self.verbs((verb,)):
                found |= self.options((verb, inner))
        return found

    def options_for(self, source):
        """The options that messages of a source file may name: those of its verb, elsewhere those of any verb."""
        name = re.fullmatch(r"(?:(eval)_)?([a-z]+)_verb\.cpp", source)
        verb = tuple(part for part in name.groups() if part) if name else ()
        if not verb or verb[-1] not in self.verbs(verb[:-1]):
            return self.all_options()
        return self.options(verb).union(*(self.options((*verb, inner)) for inner in self.verbs(verb)))

    def complaint(self, words):
        """What is wrong with the words of a command behind the program's name, or None."""
        verb = ()
        for word in words:
            if word.startswith("-"):
                option = re.match(r"--?[\w-]+", word)
                if option and option.group() not in self.options(verb):
                    return f"`{' '.join(verb)}` has no option {word}"
            elif self.verbs(verb) and not PLACEHOLDER.fullmatch(word):
                if word in ("help",) or word == "VERB":
                    return None
                if word not in self.verbs(verb) and not self.help((*verb, word)):
                    return f"no verb {word} of `fusebench {' '.join(verb)}`"
                verb += (word,)
        return None


def commands(text, program):
    """The commands that a sentence names: in backticks, or behind the program's name."""
    quoted = re.findall(r"`([^`]+)`", text)
    for command in quoted:
        words = command.split()
        if words[0] == "fusebench":
            yield words[1:]
        elif words[0] in program.verbs() and len(words) > 1:
            yield words
    for words in re.findall(r"(?<![`\w/.-])fusebench((?: --?[\w-]+| [a-z][\w-]*)+)", re.sub(r"`[^`]*`", "", text)):
        if words.split()[0] in program.verbs():
            yield words.split()


def faults(program, repository):
    count = 0
    for layer in ("core", "datasets", "eval"):
        for folder, _, names in os.walk(os.path.join(repository, layer)):
            for name in sorted(names):
                if not name.endswith((".cpp", ".hpp")):
                    continue
                path = os.path.join(folder, name)
                for line, text in sentences(path):
                    place = f"{os.path.relpath(path, repository)}:{line}"
                    for words in commands(text, program):
                        count += 1
                        complaint = program.complaint(words)
                        if complaint:
                            yield f"{place}: {complaint}: {text}"
                    options = program.options_for(name) | FOREIGN
                    for option in re.findall(r"(?<![\w/.-])--[a-z][\w-]+", re.sub(r"`[^`]*`", "", text)):
                        count += 1
                        if option not in options and name not in OF_OTHER_PROGRAMS:
                            yield f"{place}: no such option {option}: {text}"
                    for page in re.findall(r"docs/[\w/-]+\.md", text):
                        count += 1
                        if not os.path.exists(os.path.join(repository, page)):
                            yield f"{place}: no page {page}: {text}"
    if count < 100:
        yield f"only {count} commands, options and pages were found in messages"


def main():
    if len(sys.argv) != 3 or sys.argv[1] in ("-h", "--help"):
        print(__doc__.strip(), file=sys.stderr)
        return 2
    found = sorted(set(faults(Program(os.path.abspath(sys.argv[1])), sys.argv[2])))
    for fault in found:
        print("FAILED: " + fault, file=sys.stderr)
    print(f"hints: {len(found)} failures")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
