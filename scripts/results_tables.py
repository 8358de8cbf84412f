#!/usr/bin/env python3
"""Writes the tables of README, docs/ and results/ from the summaries results/*.json, or checks that they are up to date.

Usage: scripts/results_tables.py [--check] [--root FOLDER]

A summary is what `fusebench bench SUITE --summary results/NAME.json` writes. A page has marked regions, of which this script
writes the content:

    <!-- results: real.json view=systems values=ate_rmse_m,silent_failures -->
    ...
    <!-- end of results -->

Several summaries, `real.json,real_peers.json`, are tables of the runs of all of them.

  view=systems    a table for each of `values`: a row for each recording, a column for each system
  view=groups     a row for each group of recordings and system, a column for each of `values`: mean [smallest, largest] over
                  the recordings of the group
  view=criteria   the acceptance criteria of the suite with their verdicts
  view=worse      for each of `values`, the recordings on which a peer is better than `system` in all replicates
  system=NAME     of view=worse
  peers=A,B       of view=worse: the systems that are compared with
  variants=A,B    only these systems, in this order; default: all, in the order of the summary
  split=NAME      of view=groups: only this split; default: held-out
  origin=short    the line below the region has version and date alone, with a link to results/README.md; default: machine and
                  command as well

Numbers of replicates are their median [smallest, largest]. Below each region is what made the numbers: version, date, machine and
command. Where a page has summaries of different versions, each region says so. Text is wrapped at 160 characters, commands are not.
Keys, units and headings are those of `fusebench list metrics` (scripts/python/fusebench_runs/metrics.json).
Exit code: 0 up to date or written; 1 with --check, pages differ; 2 usage, or a region or summary that cannot be read.
"""

import argparse
import difflib
import json
import pathlib
import re
import statistics
import sys
import textwrap

REGION = re.compile(r"(<!-- results: (\S+\.json(?:,\S+\.json)*)([^\n]*?) -->\n)(.*?)(<!-- end of results -->)", re.DOTALL)
PARAMETERS = {
    "systems": {"values", "variants"},
    "groups": {"values", "variants", "split"},
    "criteria": set(),
    "worse": {"values", "system", "peers"},
}
#: Unit of a metric to the factor, unit and decimals that pages show.
SHOWN_UNITS = {
    "m": (100, "cm", 2),
    "rad": (57.29577951308232, "deg", 2),
    "grey": (1, "grey levels", 2),
    "frames": (1, "frames", 0),
    "1": (1, "", 2),
}
SHARES = {"coverage", "silent_share"}  # of frames, shown in %
WIDTH = 160


class PageError(Exception):
    """A region or summary that cannot be read; the text says which and why."""


class Metric:
    """How a page shows a number of a run."""

    def __init__(self, row):
        self.key = row["metric"]
        self.definition = row["definition"]
        self.smaller_is_better = row["better"] == "smaller"
        self.factor, self.unit, self.decimals = SHOWN_UNITS.get(row["unit"], (1, row["unit"], 2))
        if self.key in SHARES:
            self.factor, self.unit, self.decimals = 100, "%", 1

    def text(self, value):
        return "-" if value is None else f"{self.factor * value:.{self.decimals}f}"

    def heading(self):
        return f"`{self.key}`" + (f" [{self.unit}]" if self.unit else "")


class Summary:
    """One results/*.json."""

    def __init__(self, path):
        self.name = path.name
        try:
            content = json.loads(path.read_text())
            self.origin = content["origin"]
            self.runs = content["runs"]
            self.criteria = content["criteria"]
            self.notes = content["notes"]
            self.versions = list(self.origin["versions"])
        except (OSError, ValueError, KeyError) as error:
            raise PageError(f"{path}: no summary of a suite ({type(error).__name__}: {error}); make it by `fusebench bench SUITE --summary`") from error

    def variants(self):
        return list(dict.fromkeys(run["variant"] for run in self.runs))

    def made_by(self, short):
        origin = self.origin
        text = f"`results/{self.name}`: version {', '.join(self.versions)}, {origin['date']}"
        if short:
            return text + "."
        text += f", {', '.join(origin['machines'])}."
        if origin["absent"]:
            text += " Not run, since not present: " + ", ".join(f"`{item.split(':')[0]}`" for item in origin["absent"]) + "."
        return f"{wrapped(text)}\n\n    {command_lines(origin['command'])}"


class SeveralSummaries:
    """The runs of several summaries, in their order."""

    def __init__(self, parts):
        self.parts = parts
        self.name = ",".join(part.name for part in parts)
        self.runs = [run for part in parts for run in part.runs]
        self.criteria = [criterion for part in parts for criterion in part.criteria]
        self.versions = list(dict.fromkeys(version for part in parts for version in part.versions))

    def variants(self):
        return list(dict.fromkeys(run["variant"] for run in self.runs))

    def made_by(self, short):
        return (" " if short else "\n\n").join(part.made_by(short) for part in self.parts)


def wrapped(text):
    return "\n".join(textwrap.wrap(text, WIDTH, break_long_words=False, break_on_hyphens=False))


def command_lines(command):
    """A command as an indented block, its lines joined by backslashes."""
    return " \\\n      ".join(textwrap.wrap(command, WIDTH - 10, break_long_words=False, break_on_hyphens=False))


def spread(values):
    """(median, smallest, largest), or None without values."""
    return (statistics.median(values), min(values), max(values)) if values else None


def shown(metric, values):
    """`median [smallest, largest]`; the median alone where they look the same."""
    numbers = spread(values)
    if numbers is None:
        return "-"
    middle, low, high = (metric.text(number) for number in numbers)
    return middle if low == high else f"{middle} [{low}, {high}]"


def good_values(runs, key):
    return [run["values"][key] for run in runs if run["status"] == "ok" and run["values"].get(key) is not None]


def table(header, rows, text_columns=1):
    alignment = ["---"] * text_columns + ["---:"] * (len(header) - text_columns)
    return "".join("| " + " | ".join(cells) + " |\n" for cells in [header, alignment, *rows])


def has_synthetic_imu(summary, variant):
    return any(run["imu"] == "synthetic IMU" for run in summary.runs if run["variant"] == variant)


def system_heading(summary, variant):
    return f"`{variant}`" + (", synthetic IMU" if has_synthetic_imu(summary, variant) else "")


def best_systems(cells):
    """Of {system: (median, smallest, largest)} those whose range reaches down to the one with the smallest median."""
    if len(cells) < 2:
        return set()
    best = min(cells.values())
    return {name for name, (_, low, _) in cells.items() if low <= best[2]}


def systems_view(summary, metrics, variants, _):
    recordings = list(dict.fromkeys(run["recording"] for run in summary.runs))
    text = ""
    for metric in metrics:
        rows = []
        for recording in recordings:
            runs = {v: [r for r in summary.runs if r["recording"] == recording and r["variant"] == v] for v in variants}
            cells = {v: spread(good_values(of_variant, metric.key)) for v, of_variant in runs.items()}
            best = set()
            if metric.key.startswith("ate"):  # systems with and without an IMU made from the ground truth do not compare
                for synthetic in (False, True):
                    best |= best_systems({v: c for v, c in cells.items() if c and has_synthetic_imu(summary, v) == synthetic})
            row = [recording]
            for variant, of_variant in runs.items():
                cell = shown(metric, good_values(of_variant, metric.key))
                bad = [run for run in of_variant if run["status"] != "ok"]
                if variant in best:
                    cell = f"**{cell}**"
                if bad:
                    cell += f" ({bad[0]['status']}: {len(bad)} of {len(of_variant)})"
                row.append(cell if of_variant else "")
            rows.append(row)
        text += wrapped(f"{metric.heading()}: {metric.definition}") + "\n\n"
        text += table(["recording"] + [system_heading(summary, v) for v in variants], rows) + "\n"
    return text


def recording_means(runs, key):
    """Median over the replicates of each recording."""
    by_recording = {}
    for run in runs:
        by_recording.setdefault(run["recording"], []).append(run)
    medians = [statistics.median(values) for of_one in by_recording.values() if (values := good_values(of_one, key))]
    return len(by_recording), medians


def groups_view(summary, metrics, variants, parameters):
    split = parameters.get("split", "held-out")
    rows = []
    for group in dict.fromkeys(run["group"] for run in summary.runs if run["split"] == split):
        for variant in variants:
            runs = [r for r in summary.runs if (r["split"], r["group"], r["variant"]) == (split, group, variant)]
            if not runs:
                continue
            row = [group, f"`{variant}`"]
            for index, metric in enumerate(metrics):
                count, medians = recording_means(runs, metric.key)
                if index == 0:
                    row.append(str(count))
                cell = metric.text(statistics.fmean(medians)) if medians else "-"
                if len(medians) > 1:
                    cell += f" [{metric.text(min(medians))}, {metric.text(max(medians))}]"
                row.append(cell)
            rows.append(row)
    return table(["group", "system", "recordings"] + [metric.heading() for metric in metrics], rows, 2) + "\n"


def criteria_view(summary, *_):
    rows = []
    for criterion in summary.criteria:
        measured = "-" if criterion["measured"] is None else f"{criterion['measured']:.4g}"
        rows.append([criterion["title"], criterion["verdict"], measured, criterion["limit"], str(criterion["recordings"])])
    rows.sort(key=lambda row: row[1] == "PASS")
    return table(["criterion", "verdict", "measured", "limit", "recordings"], rows, 2) + "\n"


def is_better(metric, theirs, own):
    """Whether all replicates of a peer are better than all of a system; each is spread()."""
    return theirs[2] < own[1] if metric.smaller_is_better else theirs[1] > own[2]


def worse_view(summary, metrics, _, parameters):
    system = parameters["system"]
    text = ""
    for metric in metrics:
        lines = []
        for recording in dict.fromkeys(run["recording"] for run in summary.runs):

            def values(variant):
                return good_values([r for r in summary.runs if (r["recording"], r["variant"]) == (recording, variant)], metric.key)

            own = spread(values(system))
            for peer in parameters["peers"].split(","):
                theirs = spread(values(peer))
                if theirs and (own is None or is_better(metric, theirs, own)):
                    lines.append(f"{recording}: `{peer}` {shown(metric, values(peer))}, `{system}` {shown(metric, values(system))}")
        found = "; ".join(lines) if lines else "none"
        text += wrapped(f"- {metric.heading()}: {found}").replace("\n", "\n  ") + "\n"
    return f"Where a peer is better than `{system}` by more than the ranges of the replicates:\n\n{text}\n"


def parameters_of(text, where):
    parameters = {}
    for word in text.split():
        key, equals, value = word.partition("=")
        if not equals or not value:
            raise PageError(f"{where}: '{word}' is not KEY=VALUE")
        parameters[key] = value
    view = parameters.get("view")
    if view not in PARAMETERS:
        raise PageError(f"{where}: view={view} (allowed: {' | '.join(PARAMETERS)})")
    for key in parameters.keys() - PARAMETERS[view] - {"view", "origin"}:
        raise PageError(f"{where}: view={view} has no '{key}' (allowed: {', '.join(sorted(PARAMETERS[view])) or 'none'})")
    if parameters.get("origin", "short") != "short":
        raise PageError(f"{where}: origin={parameters['origin']} (allowed: short)")
    return parameters


def content_of(summary, parameters, metrics, where):
    view = parameters["view"]
    try:
        chosen = [metrics[key] for key in parameters["values"].split(",")] if view != "criteria" else []
        missing = {"system", "peers"} - parameters.keys() if view == "worse" else set()
        if missing:
            raise KeyError(missing.pop())
    except KeyError as error:
        raise PageError(f"{where}: {error} is missing or no metric of `fusebench list metrics`") from error
    variants = parameters["variants"].split(",") if "variants" in parameters else summary.variants()
    for variant in variants:
        if variant not in summary.variants():
            raise PageError(f"{where}: {summary.name} has no runs of '{variant}' (it has {', '.join(summary.variants())})")
    return {"systems": systems_view, "groups": groups_view, "criteria": criteria_view, "worse": worse_view}[view](summary, chosen, variants, parameters)


def new_page(path, root, metrics, summaries):
    text = path.read_text()
    where = path.relative_to(root)
    regions = list(REGION.finditer(text))
    if text.count("<!-- results:") != len(regions):
        raise PageError(f"{where}: a region '<!-- results: NAME.json ... -->' has no '<!-- end of results -->', or names no .json")
    versions = set()
    for region in regions:
        names = region.group(2)
        if names not in summaries:
            parts = [Summary(root / "results" / name) for name in names.split(",")]
            summaries[names] = parts[0] if len(parts) == 1 else SeveralSummaries(parts)
        versions.update(summaries[names].versions)

    def replaced(region):
        summary = summaries[region.group(2)]
        parameters = parameters_of(region.group(3), where)
        content = content_of(summary, parameters, metrics, where)
        short = "origin" in parameters
        footer = summary.made_by(short)
        if short:
            link = pathlib.PurePath(*[".."] * (len(where.parts) - 1), "results/README.md")
            footer = wrapped(f"{footer} [Machine, commands and all numbers]({link}).")
        if len(versions) > 1:
            footer += "\n\n**Tables of this page are of different versions.**"
        return f"{region.group(1)}\n{content}{footer}\n\n{region.group(5)}"

    return text, REGION.sub(replaced, text)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter, usage=argparse.SUPPRESS)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent.parent)
    arguments = parser.parse_args()
    root = arguments.root
    stale = False
    try:
        rows = json.loads((root / "scripts/python/fusebench_runs/metrics.json").read_text())["metrics"]
        metrics = {row["metric"]: Metric(row) for row in rows}
        summaries = {}
        for path in sorted([root / "README.md", *root.glob("docs/*.md"), *root.glob("results/*.md")]):
            if not path.exists():
                continue
            old, new = new_page(path, root, metrics, summaries)
            if old == new:
                continue
            stale = True
            name = str(path.relative_to(root))
            if arguments.check:
                sys.stdout.writelines(difflib.unified_diff(old.splitlines(True), new.splitlines(True), name, "from the summaries"))
            else:
                path.write_text(new)
                print(f"results_tables: wrote {name}")
    except PageError as error:
        print(f"results_tables: {error}", file=sys.stderr)
        return 2
    if stale and arguments.check:
        print("results_tables: pages differ from results/*.json: run scripts/results_tables.py and commit the result", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
