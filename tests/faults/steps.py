"""The steps that are disturbed, by failing calls (faults.py) and by power cuts (power_cuts.py): their inputs, how they are run, and
what of their results is compared."""

import hashlib
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "attack"))

import seeds  # noqa: E402
import server  # noqa: E402

SUITE = seeds.SUITE.split("[[sweep]]")[0].replace('"no-imu", "dm-no-imu"', '"no-imu"')
STEPS = {
    "run": ["run", "tum", "--variant", "no-imu", "--set", "iekf.min_patches=1", "--threads", "1", "--out", "out"],
    "bench": ["bench", "suite.toml", "--data", ".", "--threads", "1", "--out", "out"],
    "bench -j 2": ["bench", "suite.toml", "--data", ".", "--threads", "1", "-j", "2", "--out", "out"],
    "rerun": ["bench", "suite.toml", "--data", ".", "--threads", "1", "--out", "runs"],
    # The run that is there is replaced.
    "run over a run": ["run", "tum", "--variant", "no-imu", "--imu", "auto", "--frames", "1:", "--set", "iekf.min_patches=1", "--set",
                       "tsdf.voxel_m=0.02", "--threads", "1", "--out", "runs"],
    "report": ["report", "runs", "--out", "out.html"],
    "collect": ["collect", "runs", "--out", "out.csv"],
    "merge": ["merge", "runs", "--into", "out"],
    "import": ["import", "Other", "tum/groundtruth.txt", "tum/scene.ply", "--recording", "tum", "--imu", "none", "--out", "out"],
    "export sens": ["export", "tum", "--format", "sens", "--out", "out.sens"],
    "export euroc": ["export", "tum", "--format", "euroc", "--out", "out"],
    "convert": ["convert", "tum", "--out", "out"],
    "inspect --page": ["inspect", "tum", "--page", "out.html", "--threads", "1"],
    "eval --save_results": ["eval", "ate", "tum/groundtruth.txt", "tum/groundtruth.txt", "--save_results", "out.zip"],
    "eval --errors": ["eval", "ate", "tum/groundtruth.txt", "tum/groundtruth.txt", "--errors", "out.csv"],
    "eval --colored": ["eval", "mesh", "tum/scene.ply", "tum/scene.ply", "--samples", "200", "--threads", "1", "--colored", "out.ply"],
    "simulate": ["simulate", "--format", "tum", "--size", "32x24", "--duration", "0.1", "--blur-samples", "1", "--threads", "1",
                 "--scene", "tum/scene.ply", "--trajectory", "path.txt", "--out", "out"],
}
KEEPS_PARTS = ("bench", "bench -j 2", "rerun", "merge")  # whole runs


def content(folder):
    """{file: hash} without what is never the same twice: timing and provenance of records, milliseconds of frames, invocations."""
    found = {}
    for path in sorted(pathlib.Path(folder).rglob("*")):
        name = str(path.relative_to(folder))
        if not path.is_file() or name.startswith((".fusebench", "stdout", "stderr")) or "/.fusebench/" in name:
            continue
        data = path.read_bytes()
        if name.endswith("record.json"):
            data = data.split(b'\n  "timing"')[0]
        elif name.endswith("frames.csv"):
            data = re.sub(rb"(,[^,\n]*){6}$", b"", data, flags=re.M)
        elif name.endswith("trace.json"):
            data = b""
        found[name] = hashlib.sha256(data).hexdigest()
    return found


def first_frame(run):
    return json.loads((run / "record.json").read_text())["recording"]["first_frame"]


class StepRunner:
    """Runs steps in copies of one folder of inputs, in children of one loaded process: loading alone takes longer than most steps.
    preload: names of libraries of tests that are loaded before it."""

    def __init__(self, binary, scratch, preload=()):
        self.binary = os.path.realpath(binary)
        for name in [name for name in os.environ if name.startswith(("FAULTS", "RECORD"))]:
            del os.environ[name]
        self.served = server.Program(self.binary, server.find_library(self.binary, "libfusebench_fork_server.so"),
                                     [str(server.find_library(self.binary, name)) for name in preload])
        self.scratch = pathlib.Path(os.path.realpath(scratch))
        self.inputs = self.scratch / "inputs"
        self.work = self.scratch / "work"
        seeds.simulated(self.inputs / "tum", self.program, "tum")
        seeds.write(self.inputs / "suite.toml", SUITE)
        seeds.write(self.inputs / "path.txt", "".join(f"{0.1 * k} {0.5 + 0.01 * k} 0.5 1 0 0 0 1\n" for k in range(30)))
        self.program("bench", "suite.toml", "--data", ".", "--out", "runs", "--threads", "1", cwd=self.inputs)
        # One run is missing, for `rerun` to make: not the one that "run over a run" replaces.
        shutil.rmtree(next(run for run in sorted((self.inputs / "runs" / "tum" / "no-imu").iterdir()) if first_frame(run) == 0))

    def program(self, *arguments, cwd=None, codes=(0,), env=None):
        """Its standard output, in a process of its own."""
        done = subprocess.run([self.binary, *map(str, arguments)], cwd=cwd, env=env, capture_output=True, text=True, check=False)
        if done.returncode not in codes:
            raise SystemExit(f"faults: {arguments} ends with {done.returncode}: {done.stderr}")
        return done.stdout

    def fresh(self):
        shutil.rmtree(self.work, ignore_errors=True)
        shutil.copytree(self.inputs, self.work)
        return self.work

    def command(self, arguments, settings=()):
        """(exit code or None if it hangs, standard error, output) in the folder of work. settings: "NAME=VALUE"."""
        output, errors = self.scratch / "stdout", self.scratch / "stderr"
        limits = server.Limits(cpu_s=120, wall_ms=120000, memory_mb=0, file_mb=4096)
        answer = self.served.run(self.work, arguments, output, errors, limits, settings)
        return None if answer.killed else answer.status, errors.read_bytes(), output.read_bytes()

    def undisturbed(self, step):
        """(exit code, content) of a step."""
        folder = self.fresh()
        status, errors, _ = self.command(STEPS[step])
        if status != 0:
            raise SystemExit(f"faults: {step} ends with {status}: {errors.decode(errors='replace')}")
        return status, content(folder)

    def second_try(self, step, undisturbed):
        """What is wrong with the same command again, after it was disturbed, and its standard error. What lies there under a
        temporary name, as a kill leaves it, may stay."""
        left = {name for name in content(self.work) if is_temporary(name)}
        code, said, _ = self.command(STEPS[step])
        if code == 2 and b"exists already" in said:
            code = undisturbed[0]  # what stands there is complete, or the bytes differ
        found = {name: value for name, value in content(self.work).items() if name not in left}
        if code == undisturbed[0] and found == undisturbed[1]:
            return "", said
        different = [name for name in set(undisturbed[1]) | set(found) if found.get(name) != undisturbed[1].get(name)]
        return f"the second try ends with {code}, and {sorted(different)[:3]} differ", said


def scratch_folder():
    room = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None  # syncs of a disk would take most of the time
    return tempfile.TemporaryDirectory(prefix="fusebench_faults_", dir=room)


def is_temporary(name):
    """Whether it is, or is in, what a kill may leave and nobody reads."""
    return any(part.startswith(".") and part.endswith(".tmp") for part in name.split("/"))
