"""The listing's Applesoft arithmetic over numpy arrays, bit for bit.

unit         what a block of scenes shares: who failed first
reals        the 40-bit real over arrays: round, add, multiply, divide, INT, compare
polynomials  LOG EXP ^2 SIN COS
textcolumns  decimal texts to reals and back
statements   lines 280-760 and 1000-1170
realcolumns  what the caller gives, read
compiled     the statements as a program of the compiled machine
blocks       many scenes: sorted into kinds, cut into blocks, computed
result       what the caller gets
"""

from collections.abc import Mapping
from typing import Any

from ...messages.arguments import explains_arguments
from .blocks import replay_scenes
from .realcolumns import read_columns
from .result import Replay, field_names

__all__ = ["Replay", "field_names", "replay"]


@explains_arguments
def replay(columns: Mapping[str, Any], fields: bool = False, threads: int | None = None) -> Replay:
    """Run the 1988 listing's own arithmetic on many scenes at once.

    Every bit is what an Apple II Plus computes. A scene that fails on the machine fails here,
    alone.

    Parameters
    ----------
    columns : mapping of str to str, int, or sequence of them
        The scene's names (`impact88.names.SCENE`; M is 6 where left out), each one value for all
        scenes or a column of n. A value is decimal text, read as Applesoft reads it, digit by digit
        (so "90315.8817" and "90315.88170" differ in the last bit), a whole number, taken as its
        text, or a stored real: a uint64 of its five bytes (14.5 is 0x8468000000). Floats are
        refused: the digits that were typed count.
    fields : bool, default False
        Write all printed fields now; else each when it is asked for.
    threads : int, optional
        How many to use; by default as many as help.

    Returns
    -------
    Replay
        Every result as printed, as stored reals and as floats; each scene's error and line.

    Raises
    ------
    UserError
        For columns that cannot be used.

    Notes
    -----
    Lines 280-760 and 1000-1170 of the listing.

    Examples
    --------
    >>> impact88.replay(impact88.sample(1)).printed("XB").tolist()
    ['14.51']
    """
    result = replay_scenes(read_columns(columns), threads)
    if fields:
        result.write_fields()
    return result
