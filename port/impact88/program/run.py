"""Run the 1988 program on a scene, as if typed in and started with RUN.

The port reads the scene's data lines, and its velocities from the keyboard."""

from __future__ import annotations

import math
from collections import namedtuple
from collections.abc import Mapping
from contextlib import nullcontext

from ..apple.applesoft.console import Console
from ..apple.applesoft.operators import Real
from ..messages import notebook
from ..messages.arguments import explains_arguments
from . import arithmetics, listing, stepping
from .arithmetics import Arithmetic
from .scene import Scene

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

BELL = "\a"
_UNPRINTED = {code: None for code in range(32) if chr(code) not in "\n\b"}
"""Control characters that are not shown. Control-H stays, so that a deleted character is
visible."""


class Run(namedtuple("Run", "printout error line reals A zero_determinant")):
    """The record of one run of the 1988 program.

    Parameters
    ----------
    printout : str
        Every character sent to the output, RETURN as newline.
    error : str or None
        The Applesoft error that ended the run.
    line : int or None
        The line of the error.
    reals : dict of str to str or float
        Every real variable that was assigned: its five stored bytes in hexadecimal, or a float in
        double precision.
    A : dict or None
        The array A: ``dims`` (sizes) and ``data``, first subscript fastest; None before line 360.
    zero_determinant : bool
        True where the program ended at line 1160.

    Examples
    --------
    >>> run = impact88.run(impact88.sample(1))
    >>> run.error, run.reals["KI"]
    (None, '91451476e4')
    """

    __slots__ = ()
    printout: str
    error: str | None
    line: int | None
    reals: dict[str, Any]
    A: dict[str, Any] | None
    zero_determinant: bool

    @property
    def page(self) -> str:
        """The printout without control characters, for people."""
        return page(self.printout)

    @property
    def floats(self) -> dict[str, float]:
        """The real variables as floats, equal to their five stored bytes."""
        values = self.reals.items()
        real_names = {name for name, value in values if isinstance(value, str) and len(value) == 10}
        return {n: float(Real.from_stored(x) if n in real_names else x) for n, x in values}

    def __repr__(self) -> str:
        ending = self.error or ("ZERO DETERMINANT" if self.zero_determinant else "END")
        return f"<Run: {ending}; {len(self.printout)} characters, {len(self.reals)} variables>"

    def _repr_html_(self) -> str:
        """Return the printout as HTML for a notebook."""
        return notebook.preformatted_html(self.page)


def page(text: str) -> str:
    """Return a printout without characters that only a machine acts on: the form feed of line 200,
    bells, the NULs that INPUT shows for a prompt, control-D."""
    return text.translate(_UNPRINTED)


def start(
    data: Mapping[str, str],
    console: Console,
    arithmetic: str | Arithmetic = "applesoft",
    slot: str = "0",
    after_line: stepping.AfterLine | None = None,
) -> Run:
    """Run the port on a console until the program ends.

    The printout, with any error message, goes to the console; that of the returned Run is empty.
    Raises UserError for an unknown arithmetic, and `console.EndOfInput`.
    """
    chosen = arithmetics.get_arithmetic(arithmetic)
    error, zero_determinant = None, False
    tracing = stepping.after_every_line(after_line, chosen.unset) if after_line else nullcontext()
    try:
        names: Mapping[str, Any]
        with tracing:
            names = listing.impact(data, chosen, console, slot)
    except listing.End as end:
        zero_determinant = True
        _, names = stepping.failure_state(end.__traceback__)
    except Exception as exception:
        error = chosen.error(exception)
        if error is None:
            raise
        error.line, names = stepping.failure_state(exception.__traceback__)
    reals, array = stepping.variables(names, chosen.unset)
    if error is not None and error.line is not None:
        replies_read = console.reply.begun if console.reply else None
        if variable := stepping.unfinished_assignment(error.line, reals, replies_read):
            reals[variable] = chosen.zero
        console.put(f"\n?{error.kind} ERROR{BELL} IN {error.line}")
    return Run(
        "",
        error.message if error else None,
        error.line if error else None,
        {name: _record_value(value) for name, value in reals.items()},
        {"dims": array.sizes, "data": list(map(_record_value, array.data))} if array else None,
        zero_determinant,
    )


@explains_arguments
def run(
    scene: Mapping[str, str],
    arithmetic: str | Arithmetic = "applesoft",
    *,
    dos: bool = True,
    slot: int = 0,
    after_line: stepping.AfterLine | None = None,
) -> Run:
    """Run the 1988 program on a scene and return its printout, variables and error.

    Parameters
    ----------
    scene : mapping of str to str
        The scene, as texts: the digits typed matter.
    arithmetic : {"applesoft", "double"} or Arithmetic, default "applesoft"
        The arithmetic that computes and writes numbers.
    dos : bool, default True
        True if a disk system handles lines that begin with control-D.
    slot : int, default 0
        The digit of line 190: 1 is the printer, whose output is part of the printout.
    after_line : callable, optional
        Called after every BASIC line with its number and the variables.

    Returns
    -------
    Run
        The record of the run.

    Raises
    ------
    UserError
        For an unknown arithmetic, or a scene that cannot be typed into the program
        (`Scene.check_typed`).

    Examples
    --------
    >>> impact88.run(impact88.sample(1)).page.splitlines()[-3]
    ' WA= -1.745 WB= -.8202'
    """
    scene = scene if isinstance(scene, Scene) else Scene.from_mapping(scene)
    scene.check_typed()
    characters: list[str] = []
    replies = iter(scene.keyboard())
    console = Console(lambda: next(replies, None), characters.append, dos=dos)
    record = start(scene, console, arithmetic, str(slot), after_line)
    return record._replace(printout="".join(characters))


def _record_value(value: Any) -> Any:
    """Return a real's stored bytes in hexadecimal; a double unchanged, or as text if not finite."""
    if isinstance(value, Real):
        return value.to_bytes().hex()
    return value if math.isfinite(value) else str(value)
