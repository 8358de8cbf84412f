#!/usr/bin/env python3
"""Checks the rooms: the folders and namespaces that CMakeLists.txt lists in the order of the data flow, by library.

Usage: scripts/check_includes.py [ROOT]

Below ROOT (default: this repository) it checks that
  - every source of core, datasets and eval lies in the folder of a room, and every room has sources
  - a room uses only rooms before it, and its files include exactly the rooms that it declares
  - a room has at most 15 units (a header with its source)
  - a file's namespace is its room's: fusebench:: and the folders below the layer (core, datasets, eval) and below folders that group
    rooms by role (ROLES)
  - core includes neither datasets nor eval, datasets does not include eval, metrics include neither datasets nor estimator
  - only the rooms that run the estimator include both the recordings and the pipeline
  - nothing outside tests includes tests, and quoted paths start at the repository root
Prints file:line, the include and its rule for each offence; exit code 1 if there is one, 2 if there is nothing to check.
"""
import pathlib
import re
import sys

LAYERS = ("core", "datasets", "eval")
MOST_UNITS = 15
# Folders that group rooms by role. They are not part of the namespaces of the rooms inside.
ROLES = ("core/base", "core/config", "core/estimator", "core/estimator/model", "core/estimator/places", "datasets/recording",
         "eval/metrics", "eval/record", "eval/run", "eval/suites", "eval/compare", "eval/report")
# What judges an estimator knows trajectories, meshes and pixels from anywhere, and nothing of how they were made.
METRICS = {"metrics", "trajectory_files", "trajectory_error", "reference_clock", "mesh_error"}
ESTIMATOR = {"prediction", "preprocessing", "patches", "measurement", "relocalisation", "health", "core"}
# Rooms that put recordings into the pipeline; the command line lists the systems as well.
RUNNERS = {"preparation", "run", "batch_estimation", "cli"}
INCLUDE = re.compile(r'^\s*#\s*include\s*(["<])(?:fusebench/)?([^">]+)[">]')
NAMESPACE = re.compile(r"^namespace (fusebench[\w:]*) \{")


def read_rooms(text):
    """{folder: names of the rooms that it uses}, in order."""
    rooms = {}
    for call in re.finditer(r"^fusebench_room\(([^)]*)\)", text, re.MULTILINE):
        words = call.group(1).split()
        uses, inside = [], False
        for word in words[1:]:
            if word.isupper() and not word.startswith("$"):
                inside = word == "USES"
            elif inside:
                uses.append(word)
        rooms[words[0]] = uses
    return rooms


def namespace_of(folder):
    """The namespace of a room. Names of base need no prefix; groups of options are part of config, steps of a frame of core."""
    if folder == "core/base":
        return "fusebench"
    if folder in ("core/config/groups", "core/steps"):
        return "fusebench::" + folder.split("/")[-2]
    inside = [role for role in (*LAYERS, *ROLES) if folder.startswith(role + "/")]
    parts = folder[len(max(inside, key=len)) + 1:] if inside else folder
    return "::".join(["fusebench", *parts.split("/")])


class Check:
    def __init__(self, root):
        self.root = root
        self.rooms = read_rooms((root / "CMakeLists.txt").read_text())
        self.folder_of = {folder.split("/")[-1]: folder for folder in self.rooms}
        self.place = {name: i for i, name in enumerate(self.folder_of)}
        self.offences = 0

    def offence(self, where, what, rule):
        print(f"{where}: {what}\n    rule: {rule}")
        self.offences += 1

    def check_list(self):
        if len(self.folder_of) != len(self.rooms):
            self.offence("CMakeLists.txt", "two rooms have one name", "the last names of rooms differ")
        for folder, uses in self.rooms.items():
            for used in uses:
                if self.place.get(used, len(self.place)) >= self.place[folder.split("/")[-1]]:
                    self.offence("CMakeLists.txt", f"{folder} uses {used}", "a room uses only rooms before it")

    def check_room(self, folder, files):
        units = {file.stem for file in files}
        if not files:
            self.offence(folder, "no sources", "every room has sources")
        if len(units) > MOST_UNITS:
            self.offence(folder, f"{len(units)} units", f"a room has at most {MOST_UNITS} units")
        included = {}
        for file in files:
            self.check_file(folder, file, included)
        for unused in set(self.rooms[folder]) - set(included):
            self.offence("CMakeLists.txt", f"{folder} uses {unused}", "a room uses what its files include")

    def check_file(self, folder, file, included):
        layer = folder.split("/")[0]
        for number, line in enumerate(file.read_text().splitlines(), 1):
            where = f"{file.relative_to(self.root)}:{number}"
            opened = NAMESPACE.match(line)
            if opened and opened.group(1) != namespace_of(folder):
                self.offence(where, line.strip(), f"the namespace of {folder} is {namespace_of(folder)}")
            match = INCLUDE.match(line)
            if not match:
                continue
            quoted, path = match.group(1) == '"', match.group(2)
            if quoted and path.split("/")[0] not in (*LAYERS, "tests"):
                self.offence(where, line.strip(), "quoted paths start at the repository root")
            self.check_layers(where, line.strip(), layer, path)
            other = str(pathlib.PurePosixPath(path).parent)
            if path.split("/")[0] not in LAYERS or other == folder:
                continue
            name = other.split("/")[-1]
            if self.folder_of.get(name) != other:
                self.offence(where, line.strip(), "there is no such room")
                continue
            included[name] = where
            if name not in self.rooms[folder]:
                self.offence(where, line.strip(), f"{folder} does not use {name} (CMakeLists.txt)")

    def check_layers(self, where, line, layer, path):
        if layer == "core" and path.startswith(("datasets/", "eval/")):
            self.offence(where, line, "core includes neither datasets nor eval")
        if layer == "datasets" and path.startswith("eval/"):
            self.offence(where, line, "datasets does not include eval")
        if path.startswith("tests/"):
            self.offence(where, line, "nothing outside tests includes tests")

    def check_roles(self):
        for folder, uses in self.rooms.items():
            name = folder.split("/")[-1]
            known = set(uses)
            if name in METRICS and (known & ESTIMATOR or any(self.layer(used) == "datasets" for used in known)):
                self.offence("CMakeLists.txt", f"{folder} uses {' '.join(uses)}",
                             "metrics know neither recordings nor the estimator")
            if name not in RUNNERS and "core" in known and any(self.layer(used) == "datasets" for used in known):
                self.offence("CMakeLists.txt", f"{folder} uses {' '.join(uses)}",
                             f"only {' and '.join(sorted(RUNNERS))} use both recordings and the pipeline")

    def layer(self, name):
        return self.folder_of.get(name, "").split("/")[0]

    def run(self):
        files = [file for layer in LAYERS for file in sorted((self.root / layer).rglob("*.[ch]pp"))]
        if not files or not self.rooms:
            print(f"check_includes: there are no rooms in {self.root}", file=sys.stderr)
            return 2
        self.check_list()
        by_folder = {folder: [] for folder in self.rooms}
        for file in files:
            folder = str(file.parent.relative_to(self.root))
            if folder in by_folder:
                by_folder[folder].append(file)
            elif not file.name.endswith("_oiio.cpp"):  # a module of its own, which no room includes
                self.offence(str(file.relative_to(self.root)), "lies in no room", "every source lies in a room")
        for folder, inside in by_folder.items():
            self.check_room(folder, inside)
        self.check_roles()
        if not self.offences:
            print(f"rooms: {len(self.rooms)}, {len(files)} files, all as listed")
        return 1 if self.offences else 0


def main():
    if sys.argv[1:2] in (["-h"], ["--help"]):
        print(__doc__)
        return 0
    if len(sys.argv) > 2:
        print(__doc__, file=sys.stderr)
        return 2
    root = pathlib.Path(sys.argv[1]) if len(sys.argv) == 2 else pathlib.Path(__file__).resolve().parent.parent
    return Check(root).run()


if __name__ == "__main__":
    sys.exit(main())
