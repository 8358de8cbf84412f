"""Tables of named columns, which pandas takes as they are."""

import csv
import math
import re


class Columns(dict):
    """Name of a column to the list of its values; all lists have one length."""

    def __len__(self):
        """Number of rows."""
        return len(next(iter(self.values()), []))

    def rows(self):
        """Each row as a dict."""
        for values in zip(*self.values()):
            yield dict(zip(self.keys(), values))

    def __str__(self):
        cells = [list(self.keys())] + [[_text(value) for value in row.values()] for row in self.rows()]
        widths = [max(len(row[i]) for row in cells) for i in range(len(self.keys()))]
        return "\n".join("  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() for row in cells)


def _text(value):
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def table_of(columns, frames=None):
    """Columns as they are, or as a DataFrame (see the package)."""
    if frames is False:
        return Columns(columns)
    try:
        import pandas
    except ImportError:
        if frames:
            raise
        return Columns(columns)
    return pandas.DataFrame(dict(columns))


def nanoseconds(seconds):
    """Of a stamp's text. A float would lose the last digits of one since 1970."""
    whole, _, fraction = seconds.partition(".")
    sign = -1 if whole.startswith("-") else 1
    return int(whole) * 10**9 + sign * int((fraction + "000000000")[:9])


#: Columns of words, also where all of them are empty, which else is a column of NaN.
_TEXTS = {"status", "health", "reason", "part", "verified_by", "decision", "why"}


#: What fusebench puts an apostrophe before, so that no spreadsheet takes it for a formula.
_SHIELDED = re.compile(r"'+[=+\-@\t\r]")


def _words(cells):
    """Cells as they were before they were kept from being formulas."""
    return [cell[1:] if _SHIELDED.match(cell) else cell for cell in cells]


def _numbers(cells):
    """Cells as numbers, empty ones as NaN; None if one is no number. Whole numbers stay whole."""
    try:
        return [int(cell) for cell in cells]
    except ValueError:
        pass
    try:
        return [float(cell) if cell else math.nan for cell in cells]
    except ValueError:
        return None


def read_csv(file, frames=None):
    """A table of a run, or one that `collect`, `table` or `best` prints as CSV. A column of stamps in seconds ("timestamp", "query_s") has one in nanoseconds beside it
    ("timestamp_ns", "query_ns"), which is exact."""
    with open(file, newline="", encoding="utf-8") as stream:
        names, *rows = csv.reader(stream)
    names[0] = names[0].removeprefix("# ")
    for number, row in enumerate(rows, start=2):
        if len(row) != len(names):
            raise ValueError(f"{file}:{number}: {len(row)} cells, {len(names)} columns")
    columns = Columns()
    for index, name in enumerate(names):
        cells = [row[index] for row in rows]
        numbers = None if name in _TEXTS else _numbers(cells)
        columns[name] = _words(cells) if numbers is None else numbers
        if name in ("timestamp", "capture_timestamp", "timestamp_s", "query_s", "place_s"):
            columns[name.removesuffix("_s") + "_ns"] = [nanoseconds(cell) for cell in cells]
    return table_of(columns, frames)
