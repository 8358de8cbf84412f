"""Trajectories of a run and their errors."""

import math
from typing import NamedTuple

from .columns import nanoseconds


class Pose(NamedTuple):
    """A pose of the colour camera: position in metres, rotation as a unit quaternion."""

    timestamp_ns: int
    x: float
    y: float
    z: float
    qx: float
    qy: float
    qz: float
    qw: float


def read_trajectory(file):
    """Poses of a TUM file, in its order."""
    poses = []
    with open(file, encoding="utf-8") as stream:
        for number, line in enumerate(stream, start=1):
            words = line.split()
            if not words or words[0].startswith("#"):
                continue
            if len(words) != 8:
                raise ValueError(f"{file}:{number}: {len(words)} words, a pose has 8")
            poses.append(Pose(nanoseconds(words[0]), *map(float, words[1:])))
    return poses


def associate(first_ns, second_ns, max_difference_ns):
    """Pairs of indices into two sorted lists, by the rule of TUM's associate.py: the closest first, each at most once."""
    candidates = []
    begin = 0
    for i, stamp in enumerate(first_ns):
        while begin < len(second_ns) and second_ns[begin] <= stamp - max_difference_ns:
            begin += 1
        j = begin
        while j < len(second_ns) and second_ns[j] < stamp + max_difference_ns:
            candidates.append((abs(stamp - second_ns[j]), i, j))
            j += 1
    used_first, used_second, pairs = set(), set(), []
    for _, i, j in sorted(candidates):
        if i not in used_first and j not in used_second:
            used_first.add(i)
            used_second.add(j)
            pairs.append((i, j))
    return sorted(pairs)


def moved(matrix, point):
    """A point (x, y, z) by a 4x4 matrix, row by row, as records have it."""
    return tuple(sum(matrix[4 * row + k] * point[k] for k in range(3)) + matrix[4 * row + 3] for row in range(3))


def position_errors(run):
    """[(timestamp_ns, error in metres)] of a run's trajectory.tum, moved as its ATE did it; their RMS is that of the record."""
    ate = run.record["metrics"]["ate"]
    if ate["stats"] is None:
        raise ValueError(f"{run.folder}: no ATE: {ate['reason']}")
    truth, estimate = run.truth(), run.trajectory()
    pairs = associate([pose.timestamp_ns for pose in truth], [pose.timestamp_ns for pose in estimate],
                      round(1e9 * ate["max_difference_s"]))
    matrix = ate["alignment"]["matrix"]
    return [(estimate[j].timestamp_ns, math.dist(truth[i][1:4], moved(matrix, estimate[j][1:4]))) for i, j in pairs]
