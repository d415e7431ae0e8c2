"""Inputs that were not read, but that the results which were read leave no choice in.

Where a scan lost one or two of the inputs and all results come out digit for digit with a number in
its place, and no longer do with that number's last digit one up or down, the number is as good as
read: it is doubtful, and is listed, but nothing of the scene is missing. What can be read as
another number is not lost, and a result is never borne out: nothing printed hangs on it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ..fields import ANGLES, INPUTS
from ..reading.glyphs import LOOK_ALIKES, NUMERIC
from ..reading.numerals import Doubt, candidates
from ..reading.printout import Printout
from ..recovery import replays
from ..recovery.choices import scene_name
from ..recovery.recovered import Recovered
from .judgement import Doubtful, FieldCheck, Status

MOST = 2
"""Inputs not read at most: with more unknown, other scenes may print the same."""


def borne_out(shown: Printout, recovered: Recovered, checks: Sequence[FieldCheck]) -> bool:
    """Whether every number not read is an input that the results settle; those become doubtful."""
    lost = [one for one in checks if one.status in (Status.NOT_READ, Status.NOT_COMPARED)]
    if len(lost) > MOST or any(one.name not in INPUTS for one in lost):
        return False
    if any(_reads_as_a_number(shown, one) for one in lost):
        return False
    results = {
        one.name: one.recomputed
        for one in checks
        if one.status == Status.READ and one.name not in INPUTS
    }
    for check in lost:
        name = scene_name(check.name)
        others = [{**recovered.scene, name: text} for text in _next_to(recovered.scene[name])]
        for outcome in replays.run_all(others):
            if all(outcome.fields.get(name) == text for name, text in results.items()):
                return False
    for check in lost:
        _doubted(shown, check)
    return True


def _reads_as_a_number(shown: Printout, check: FieldCheck) -> bool:
    """Whether what stands in a number's place can be read as one, if not as the one printed: an
    ``&`` may be an 8 or a 6, and is no 0 that nobody can read. What an edge left of a number is
    none."""
    if check.start is None or check.stop is None or shown.page is None:
        return False
    hows = {doubt.how for doubt in check.doubts}
    if Doubt.CUT in hows and Doubt.CONTRADICTS not in hows:
        return False
    glyphs = shown.page.glyphs
    region = tuple(one for one in glyphs if check.start <= one.offset < check.stop)
    foreign = any(one.char not in NUMERIC and one.char not in LOOK_ALIKES for one in region)
    return not foreign and bool(candidates(region, 1))


def _doubted(shown: Printout, check: FieldCheck) -> None:
    """The check as one of a number whose glyphs, if any, nobody can read."""
    start = check.start if check.start is not None else _before(shown, check.name)
    line, column = shown.place(start)
    read, printed = check.printed or "", check.recomputed or ""
    check.status, check.same = Status.DOUBTFUL, None
    check.doubts = [Doubtful(line, column, start, read, printed, str(Doubt.ILLEGIBLE))]


def _before(shown: Printout, name: str) -> int:
    """About where a number should stand of which nothing was read: after the one before it."""
    names = [*INPUTS[: INPUTS.index(name)]]
    for other in reversed(names):
        if other in shown.fields and other not in ANGLES:
            return shown.fields[other].stop
    return shown.start


def _next_to(text: str) -> Iterator[str]:
    """The numbers one up and one down in the last digit."""
    value, _, exponent = text.partition("E")
    decimals = len(value.partition(".")[2])
    for step in (1, -1):
        other = f"{float(value) + step * 10.0**-decimals:.{decimals}f}"
        yield other + (f"E{exponent}" if exponent else "")
