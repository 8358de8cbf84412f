"""Folders of runs."""

import json
import math
import pathlib

from .columns import read_csv, table_of
from .intensity import read_intensity
from .trajectories import read_trajectory

SCHEMA = 1

#: What `fusebench list metrics` says of the numbers that records hold, by their keys.
METRICS = {metric["metric"]: metric for metric in
           json.loads((pathlib.Path(__file__).parent / "metrics.json").read_text(encoding="utf-8"))["metrics"] if metric["record"]}


class Run:
    """A run's folder. `record` is its record.json (docs/record.schema.json)."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        file = self.folder / "record.json"
        try:
            self.record = json.loads(file.read_text(encoding="utf-8"))
        except ValueError as error:
            raise ValueError(f"{file}: damaged: {error}") from error
        if not isinstance(self.record, dict) or "schema" not in self.record:
            raise ValueError(f"{file}: damaged: no record of a run")
        if self.record["schema"] != SCHEMA:
            raise ValueError(f"{file}: schema = {self.record['schema']} (this module reads {SCHEMA})")

    @classmethod
    def damaged(cls, folder, reason):
        """A run whose record cannot be read: status "damaged", without numbers; names are those of its folders."""
        run = cls.__new__(cls)
        run.folder = pathlib.Path(folder)
        names = run.folder.resolve().parts
        run.record = {"recording": {"name": names[-3] if len(names) > 3 else ""}, "variant": names[-2] if len(names) > 2 else "",
                      "status": "damaged", "reason": reason, "config": {}, "metrics": {}, "timing": {"fps": math.nan}}
        return run

    def __repr__(self):
        return f"<Run {self.recording} {self.label} {self.status}>"

    @property
    def recording(self):
        return self.record["recording"]["name"]

    @property
    def variant(self):
        return self.record["variant"]

    @property
    def status(self):
        """ok, lost, failed, or damaged: the record cannot be read."""
        return self.record["status"]

    @property
    def reason(self):
        """Why the run is not ok; empty if it is."""
        return self.record["reason"]

    @property
    def edits(self):
        """Options that a file, --set, a suite or a sweep gave: {"tsdf.voxel_m": 0.02}."""
        return {key: option["value"] for key, option in self.record["config"].items()
                if option["origin"] != "default" and not option["origin"].startswith("variant ")}

    @property
    def label(self):
        """The variant, and the options that were edited: "full tsdf.voxel_m=0.02"."""
        return " ".join([self.variant] + [f"{key}={_as_typed(value)}" for key, value in self.edits.items()])

    def has(self, name):
        """Whether the run has that file."""
        return (self.folder / name).is_file()

    def number(self, key):
        """A number by the key that tables and gates have for it ("ate_rmse_m"; `fusebench list metrics`), NaN where there is none.

        Raises KeyError for a key that no metric has, or whose number is computed from others (`fusebench collect` has those)."""
        value = self.record
        for name in METRICS[key]["record"].split("."):
            if isinstance(value, list) and name.isdigit() and int(name) < len(value):
                value = value[int(name)]
            elif isinstance(value, dict) and name in value:
                value = value[name]
            else:
                return math.nan
        return value if isinstance(value, (int, float)) else math.nan

    def metric(self, path, default=math.nan):
        """A number of record["metrics"], by its path: "ate/stats/rmse"; default where there is none."""
        value = self.record["metrics"]
        for key in path.split("/"):
            if not isinstance(value, dict) or key not in value:
                return default
            value = value[key]
        return default if value is None else value

    def frames(self, frames=None):
        """frames.csv, a row per frame."""
        return read_csv(self.folder / "frames.csv", frames)

    def states(self, frames=None):
        """states.csv, a row per frame."""
        return read_csv(self.folder / "states.csv", frames)

    def nees(self, frames=None):
        """nees.csv, a row per frame and part of the state."""
        return read_csv(self.folder / "nees.csv", frames)

    def patches(self, frames=None):
        """patches.csv, a row per pixel of the frames that moved most."""
        return read_csv(self.folder / "patches.csv", frames)

    def loops(self, frames=None):
        """loops.csv, a row per candidate."""
        return read_csv(self.folder / "loops.csv", frames)

    def places(self, frames=None):
        """places.csv, a row per place."""
        return read_csv(self.folder / "places.csv", frames)

    def intensity(self):
        """intensity.bin: see read_intensity()."""
        return read_intensity(self.folder / "intensity.bin")

    def trajectory(self):
        """Poses of tracked frames; the world is the first camera."""
        return read_trajectory(self.folder / "trajectory.tum")

    def final(self):
        """Poses as the system revised them at the end."""
        return read_trajectory(self.folder / "final.tum")

    def truth(self):
        """The ground truth as it was read, in its own world; nothing where there is none."""
        if self.record["recording"].get("truth") == "none":
            return []
        return read_trajectory(self.folder / "truth.tum")


def _as_typed(value):
    return str(value).lower() if isinstance(value, bool) else str(value)


def _run_in(folder):
    try:
        return Run(folder)
    except ValueError as error:
        return Run.damaged(folder, str(error))


def open_runs(folder):
    """Every run below a folder, by its place; one whose record is damaged has the status "damaged" and a reason.

    Raises FileNotFoundError if there is none."""
    folder = pathlib.Path(folder)
    # Folders whose names begin with a point belong to runs that are not finished.
    records = [file for file in sorted(folder.rglob("record.json"))
               if not any(part.startswith(".") for part in file.relative_to(folder).parts)]
    if not records:
        raise FileNotFoundError(f"{folder}: no runs (no record.json at any depth)")
    return [_run_in(file.parent) for file in records]


def summary(runs, frames=None):
    """A row per run: the variant, each option that any of the runs edited (its value in every run that has it, as in record.json; None in
    others) by its key, and the numbers that are columns of tables, by their keys (`fusebench list metrics`)."""
    options = sorted({key for run in runs for key in run.edits})
    columns = {
        "recording": [run.recording for run in runs],
        "label": [run.label for run in runs],
        "variant": [run.variant for run in runs],
        **{key: [run.record["config"].get(key, {}).get("value") for run in runs] for key in options},
        "status": [run.status for run in runs],
        "reason": [run.reason for run in runs],
        **{key: [run.number(key) for run in runs] for key, metric in METRICS.items() if metric["tables"]},
        "folder": [str(run.folder) for run in runs],
    }
    return table_of(columns, frames)
