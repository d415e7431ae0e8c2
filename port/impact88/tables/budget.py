"""The limits of a table: one budget for all readers of what a file decodes to.

Anybody may have made a file: a packed one, a dictionary of texts or a cell far away decode to a
thousand times its size. Every reader takes from a `Budget` before it uses the memory.
"""

import os

from ..errors import UserError
from ..files import display_name

MAX_DECODED = 256_000_000  # bytes that any file may decode to
# a larger one may decode to this many times its size: doubles pack to a third, and with twice as
# much a file of 100 MB may take 4 GB of memory
MAX_DECODED_RATIO = 20
MAX_COLUMNS = 10_000  # a table has some fifty
MAX_CELLS = 500_000_000  # ten million rows of fifty columns
EMPTY_CELL = 64
"""Bytes counted for a cell that a row lacks and its column has all the same, and for a line that
holds nothing."""


class Budget:
    """The bytes that one table may still decode to.

    Parameters
    ----------
    path : str
        The file, whose size sets the ``limit``; ``-`` is standard input.
    """

    def __init__(self, path: str) -> None:
        self.where = display_name(path)
        self.size = os.path.getsize(path) if path != "-" and os.path.isfile(path) else 0
        self.limit = max(MAX_DECODED, MAX_DECODED_RATIO * self.size)
        self.taken = 0

    def take(self, size: int) -> None:
        """Count ``size`` decoded bytes. Raises UserError past the limit."""
        self.taken += size
        if self.taken > self.limit:
            raise UserError(
                f"has {self.size:,} bytes that unpack to {self.taken:,} or more; at most "
                f"{self.limit:,} are read (a file that is stored unpacked may hold more)",
                self.where,
            )

    def check_shape(self, columns: int, rows: int = 0) -> None:
        """Raise UserError for more columns or cells than a table has."""
        if columns > MAX_COLUMNS:
            raise UserError(
                f"has {columns:,} columns; at most {MAX_COLUMNS:,} are read", self.where
            )
        if columns * rows > MAX_CELLS:
            raise UserError(
                f"has {rows:,} rows of {columns:,} columns; at most {MAX_CELLS:,} cells are read",
                self.where,
            )
