"""Opens what FuseBench's runs leave (docs/files.md), as pandas data frames, or without pandas as plain columns.

    import fusebench_runs
    runs = fusebench_runs.open_runs("results/runs/quickstart")
    print(fusebench_runs.summary(runs))
    frames = runs[0].frames()

Needs nothing but the standard library. Functions that return a table take `frames`: True for pandas' DataFrame (an ImportError
where it is not installed), False for Columns, None (the default) for the one where pandas is there and the other where not.
"""

from .columns import Columns, table_of
from .intensity import IntensityError, IntensityFrame, read_intensity
from .runs import METRICS, Run, open_runs, summary
from .trajectories import Pose, position_errors, read_trajectory

__all__ = ["Columns", "IntensityError", "IntensityFrame", "METRICS", "Pose", "Run", "open_runs", "position_errors", "read_intensity",
           "read_trajectory", "summary", "table_of"]
