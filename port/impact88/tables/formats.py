"""The one table of table formats: `FORMATS`, a row for each.

The choices of ``--from`` and ``--to``, the endings that name a format, the modules that read and
write it and the list in the help of ``solve`` all come from its row.
"""

from importlib import import_module
from types import ModuleType
from typing import NamedTuple


class Format(NamedTuple):
    """A format of tables.

    ``name`` is what ``--from`` and ``--to`` take; ``endings`` are those of file names. ``module``
    is a module of this package with two context managers: ``read(path, encoding, results)`` yields
    a `rows.Reader`, and ``write(path, delimiter, headings)`` yields a function that takes the
    columns of each block in turn. ``summary`` stands in the help,
    ``noun`` in messages about one such table.

    ``is_text``: read from standard input and written to standard output, in any encoding.
    ``pipes_out``: binary, and yet written to standard output unless that is a terminal.
    ``rows_vary``: a row may lack columns, or have new ones. ``keeps_arrays``: a column may be an
    array of any shape, not only a cell for each row.
    """

    name: str
    endings: tuple[str, ...]
    module: str
    summary: str
    noun: str
    is_text: bool = False
    pipes_out: bool = False
    rows_vary: bool = False
    keeps_arrays: bool = False

    def load(self) -> ModuleType:
        """Import the module, which imports what it needs."""
        return import_module(f"{__package__}.{self.module}")


ROWS = (
    Format(
        name="csv",
        endings=(".csv", ".tsv", ".txt"),
        module="csvtable",
        summary="comma-separated values, also .csv.gz",
        noun="a CSV table",
        is_text=True,
    ),
    Format(
        name="jsonl",
        endings=(".jsonl", ".ndjson", ".json"),
        module="jsontable",
        summary="JSON Lines, or an array of objects",
        noun="a table of JSON Lines",
        is_text=True,
        rows_vary=True,
    ),
    Format(
        name="npz",
        endings=(".npz",),
        module="npztable",
        summary="numpy's archive, an array a column",
        noun="an .npz table",
        pipes_out=True,
        keeps_arrays=True,
    ),
    Format(
        name="parquet",
        endings=(".parquet",),
        module="arrowtable",
        summary="Parquet, with impact88[arrow]",
        noun="a table of typed columns",
    ),
    Format(
        name="xlsx",
        endings=(".xlsx",),
        module="excel",
        summary="Excel, with impact88[excel]",
        noun="a workbook",
    ),
)
FORMATS = {row.name: row for row in ROWS}
"""Name -> format."""
ENDINGS = {ending: row.name for row in ROWS for ending in row.endings}
"""File name ending -> name of the format."""
