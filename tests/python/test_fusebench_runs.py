"""Tests of scripts/python/fusebench_runs on a run that the program has just written, and on files made here.

FUSEBENCH_RUNS names the folder of runs, FUSEBENCH_ROOT the repository. Standard library only.
"""

import builtins
import json
import math
import os
import pathlib
import struct
import sys
import tempfile
import unittest
from unittest import mock

ROOT = pathlib.Path(os.environ["FUSEBENCH_ROOT"])
sys.path.insert(0, str(ROOT / "scripts" / "python"))
sys.dont_write_bytecode = True

import fusebench_runs  # noqa: E402
from fusebench_runs import columns, trajectories  # noqa: E402


def rms(values):
    return math.sqrt(sum(value * value for value in values) / len(values))


class AWrittenRun(unittest.TestCase):
    def setUp(self):
        self.run_of_test = fusebench_runs.open_runs(os.environ["FUSEBENCH_RUNS"])[0]

    def test_the_errors_of_its_poses_give_the_ate_of_its_record(self):
        errors = fusebench_runs.position_errors(self.run_of_test)
        ate = self.run_of_test.record["metrics"]["ate"]
        self.assertEqual(len(errors), ate["pairs"])
        self.assertAlmostEqual(rms([error for _, error in errors]), ate["stats"]["rmse"], delta=1e-12)
        self.assertEqual(self.run_of_test.metric("ate/stats/rmse"), ate["stats"]["rmse"])

    def test_its_intensities_give_the_aie_of_its_record(self):
        _, frames = self.run_of_test.intensity()
        means = [frame.mean_grey() for frame in frames if frame.pixel]
        aie = self.run_of_test.record["metrics"]["aie"]
        self.assertAlmostEqual(sum(means) / len(means), aie["aie"], delta=1e-9)
        self.assertEqual(sum(len(frame.pixel) for frame in frames), aie["pixels"])
        self.assertEqual(sum(sum(frame.accepted) for frame in frames), aie["accepted"]["pixels"])

    def test_its_tables_have_a_row_a_frame(self):
        frames = self.run_of_test.frames(frames=False)
        total = self.run_of_test.record["frames"]["total"]
        self.assertEqual(len(frames), total)
        self.assertEqual(len(self.run_of_test.states(frames=False)), total)
        self.assertEqual(frames["status"][0], "initialised")
        self.assertTrue(math.isnan(frames["aie_grey"][0]))
        self.assertEqual(set(frames["reason"]), {""})
        tracked = {pose.timestamp_ns for pose in self.run_of_test.trajectory()}
        self.assertLessEqual(tracked, set(frames["timestamp_ns"]))
        self.assertEqual(len(next(iter(frames.rows()))), len(frames.keys()))

    def test_a_run_without_truth_has_none(self):
        self.assertTrue(self.run_of_test.truth())
        with tempfile.TemporaryDirectory() as folder:
            record = dict(self.run_of_test.record)
            record["recording"] = {**record["recording"], "truth": "none"}
            (pathlib.Path(folder) / "record.json").write_text(json.dumps(record), encoding="utf-8")
            self.assertEqual(fusebench_runs.Run(folder).truth(), [])

    def test_the_label_has_the_options_that_were_edited(self):
        self.assertEqual(self.run_of_test.label, "no-imu patches.size_px=12")
        table = fusebench_runs.summary([self.run_of_test], frames=False)
        self.assertEqual(table["label"], [self.run_of_test.label])
        self.assertIn("no-imu patches.size_px=12", str(table))

    def test_the_summary_has_a_column_for_each_option_that_any_run_edited(self):
        with tempfile.TemporaryDirectory() as folder:
            record = json.loads(json.dumps(self.run_of_test.record))
            del record["config"]["patches.size_px"]
            (pathlib.Path(folder) / "record.json").write_text(json.dumps(record), encoding="utf-8")
            table = fusebench_runs.summary([self.run_of_test, fusebench_runs.Run(folder)], frames=False)
            self.assertEqual(table["patches.size_px"], [12, None])
            self.assertEqual(table["variant"], ["no-imu", "no-imu"])
            self.assertEqual(sum(key.startswith("patches.") for key in table), 1)

    def test_the_page_of_files_knows_every_file_and_column(self):
        page = (ROOT / "docs" / "files.md").read_text(encoding="utf-8")
        for file in self.run_of_test.folder.iterdir():
            name = file.name if not file.name.startswith("patches_") else "patches_FRAME.png"
            self.assertIn(f"`{name}`", page)
        for table in (self.run_of_test.frames(frames=False), self.run_of_test.patches(frames=False)):
            for name in table.keys():
                if not name.endswith("_ns"):
                    self.assertIn(f"`{name}`", page)

    def test_damage_is_named(self):
        with tempfile.TemporaryDirectory() as folder:
            damaged = pathlib.Path(folder) / "record.json"
            damaged.write_text('{"schema": 1', encoding="utf-8")
            with self.assertRaisesRegex(ValueError, "record.json: damaged"):
                fusebench_runs.Run(folder)
            damaged.write_text('{"schema": 2}', encoding="utf-8")
            with self.assertRaisesRegex(ValueError, "schema = 2 .this module reads 1"):
                fusebench_runs.Run(folder)
            damaged.unlink()
            with self.assertRaisesRegex(FileNotFoundError, "no runs"):
                fusebench_runs.open_runs(folder)


    def test_a_damaged_run_is_a_row_beside_the_others(self):
        with tempfile.TemporaryDirectory() as folder:
            places = [pathlib.Path(folder) / "desk" / variant / "01234567" for variant in ("dm", "full")]
            for place in places:
                place.mkdir(parents=True)
            (places[0] / "record.json").write_text('{"schema": 1', encoding="utf-8")
            (places[1] / "record.json").write_text(json.dumps(self.run_of_test.record), encoding="utf-8")
            damaged, whole = fusebench_runs.open_runs(folder)
            self.assertEqual((damaged.recording, damaged.variant, damaged.status), ("desk", "dm", "damaged"))
            self.assertRegex(damaged.reason, "record.json: damaged")
            table = fusebench_runs.summary([damaged, whole], frames=False)
            self.assertEqual(table["status"], ["damaged", self.run_of_test.status])
            self.assertTrue(math.isnan(table["ate_rmse_m"][0]))
            self.assertTrue(math.isnan(table["fps"][0]))


class Intensities(unittest.TestCase):
    WHOLE = (b"FBINTENS" + struct.pack("<III", 2, 4, 3) + struct.pack("<IqI", 1, 5_000_000_007, 3) +
             struct.pack("<III", 0, 11, 7) + struct.pack("<fff", 1.5, -2.5, -0.0) + struct.pack("<IqI", 1, 6, 0) +
             struct.pack("<IQ", 0, 2))

    def read(self, data):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "intensity.bin"
            file.write_bytes(data)
            return fusebench_runs.read_intensity(file)

    def test_a_file_by_the_published_layout(self):
        size, frames = self.read(self.WHOLE)
        self.assertEqual(size, (4, 3))
        self.assertEqual(frames[0], (5_000_000_007, [0, 11, 7], [1.5, 2.5, 0.0], [True, False, False]))
        self.assertEqual(frames[0].mean_grey(), 4 / 3)
        self.assertEqual(frames[1], (6, [], [], []))

    def test_every_shorter_file_is_refused(self):
        for size in range(len(self.WHOLE)):
            with self.assertRaises(fusebench_runs.IntensityError, msg=size):
                self.read(self.WHOLE[:size])
        with self.assertRaisesRegex(fusebench_runs.IntensityError, "end mark"):
            self.read(self.WHOLE + b"\0")

    def test_damage_is_refused(self):
        for at, value, message in ((0, b"X", "not a file"), (8, b"\1", "version 1"), (20, b"\7", "damaged"),
                                   (40, b"\14", "outside the image")):
            with self.assertRaisesRegex(fusebench_runs.IntensityError, message):
                self.read(self.WHOLE[:at] + value + self.WHOLE[at + 1:])


class Tables(unittest.TestCase):
    def test_stamps_keep_their_nanoseconds(self):
        self.assertEqual(columns.nanoseconds("1305031102.175304001"), 1305031102175304001)
        self.assertEqual(columns.nanoseconds("-1.5"), -1500000000)
        self.assertEqual(columns.nanoseconds("7"), 7000000000)

    def test_cells_become_what_they_are(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "table.csv"
            file.write_text('# timestamp,count,share,why\n1.000000001,3,,"a, b"\n2.5,4,0.5,c\n', encoding="utf-8")
            table = columns.read_csv(file, frames=False)
            self.assertEqual(table["timestamp_ns"], [1000000001, 2500000000])
            self.assertEqual(table["count"], [3, 4])
            self.assertTrue(math.isnan(table["share"][0]))
            self.assertEqual(table["why"], ["a, b", "c"])
            file.write_text("run,ate\n'=1+1,1.5\n''=1,2\n'desk',-0.5\n", encoding="utf-8")
            table = columns.read_csv(file, frames=False)
            self.assertEqual(table["run"], ["=1+1", "'=1", "'desk'"])
            self.assertEqual(table["ate"], [1.5, 2.0, -0.5])
            file.write_text("a,b\n1\n", encoding="utf-8")
            with self.assertRaisesRegex(ValueError, "table.csv:2: 1 cells, 2 columns"):
                columns.read_csv(file)

    def test_pandas_is_taken_where_it_is_and_not_needed(self):
        real = builtins.__import__

        def without_pandas(name, *rest):
            if name == "pandas":
                raise ImportError(name)
            return real(name, *rest)

        with mock.patch.object(builtins, "__import__", without_pandas):
            self.assertIsInstance(fusebench_runs.table_of({"a": [1]}), fusebench_runs.Columns)
            with self.assertRaises(ImportError):
                fusebench_runs.table_of({"a": [1]}, frames=True)
        pandas = mock.Mock()
        with mock.patch.dict(sys.modules, {"pandas": pandas}):
            fusebench_runs.table_of(columns.Columns(a=[1]))
        pandas.DataFrame.assert_called_once_with({"a": [1]})


class Association(unittest.TestCase):
    def test_the_closest_come_first_and_each_at_most_once(self):
        self.assertEqual(trajectories.associate([0, 10, 20], [9, 12, 100], 5), [(1, 0)])
        self.assertEqual(trajectories.associate([0, 10], [5, 11], 6), [(0, 0), (1, 1)])
        self.assertEqual(trajectories.associate([0], [5], 5), [])  # strictly


class Notebook(unittest.TestCase):
    def test_its_cells_are_python_and_hold_no_output(self):
        notebook = json.loads((ROOT / "scripts" / "python" / "report_figures.ipynb").read_text(encoding="utf-8"))
        self.assertEqual(notebook["nbformat"], 4)
        cells = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
        self.assertGreater(len(cells), 4)
        for cell in cells:
            compile("".join(cell["source"]), "cell", "exec")
            self.assertEqual((cell["outputs"], cell["execution_count"]), ([], None))

    def test_its_figures_are_drawn_where_matplotlib_is(self):
        try:
            import matplotlib
        except ImportError:
            self.skipTest("matplotlib is not installed")
        matplotlib.use("Agg")
        notebook = json.loads((ROOT / "scripts" / "python" / "report_figures.ipynb").read_text(encoding="utf-8"))
        names = {}
        with mock.patch.dict(os.environ, {"RUNS": os.environ["FUSEBENCH_RUNS"]}):
            for cell in notebook["cells"]:
                if cell["cell_type"] == "code":
                    exec(compile("".join(cell["source"]), "cell", "exec"), names)  # noqa: S102
        import matplotlib.pyplot
        self.assertGreaterEqual(len(matplotlib.pyplot.get_fignums()), 5)


if __name__ == "__main__":
    unittest.main()
