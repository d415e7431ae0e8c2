"""The listing's Applesoft arithmetic over numpy arrays, bit for bit.

blockerrors  the errors of a block of scenes: the first of each
reals        the 40-bit real over arrays: round, add, multiply, divide, INT, compare
polynomials  LOG EXP ^2 SIN COS
textcolumns  decimal texts to reals and back
statements   lines 280-760 and 1000-1170
realcolumns  the caller's columns as stored reals
compiled     the statements as a program of the compiled machine (realmachine)
blocks       many scenes, sorted into kinds, cut into blocks and computed
result       the `Replay` that the caller gets
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

    Every bit is that of an Apple II Plus. A scene that ends with an error there ends with the same
    error here, without affecting the others.

    Parameters
    ----------
    columns : mapping of str to str, int, or sequence of them
        Values by the scene's names (`impact88.names.SCENE`; M defaults to 6), each one value for
        all scenes or a column of n. A value is decimal text, which Applesoft reads digit by digit
        (so "90315.8817" and "90315.88170" differ in the last bit), a whole number, which stands for
        its text, or a stored real: a uint64 of its five bytes (14.5 is 0x8468000000). Floats are
        refused, because the digits typed matter.
    fields : bool, default False
        Write all printed fields now; otherwise each is written on first use.
    threads : int, optional
        Maximum number of threads; by default as many as help.

    Returns
    -------
    Replay
        The results as printed, as stored reals and as floats; each scene's error and its line.

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
