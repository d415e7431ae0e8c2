"""Other causes than a misread number: another place, unit, M, program or arithmetic.

Each is a hypothesis about the whole page, replayed: scenes over arrays, other arithmetics through
the listing itself.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from ..doubles import double
from ..fields import INPUTS
from ..reading.numerals import value_of
from ..reading.printout import Printout
from ..recovery import replays
from ..recovery.choices import with_opposite_mu
from ..recovery.recovered import Recovered
from ..recovery.rereading import Change
from ..recovery.search import AGREES, Expected, expected_results
from .hypothesis import (
    MU_SIGN,
    NOT_APPLESOFT,
    OTHER_M,
    POINT_MASS,
    PROGRAM,
    UNITS,
    Hypothesis,
)
from .otherinputs import SPEEDS, SPINS, other_inputs
from .othermachines import Machines
from .otherprints import Prints, energy, exchanged
from .refining import nearest

_ROUGHLY = 1e-3
_REPLAYED = 80


class Tried(NamedTuple):
    """A hypothesis and the names in which the page still differs from it."""

    hypothesis: Hypothesis
    scene: dict[str, str]
    wrong: frozenset[str]


def hypotheses(shown: Printout, recovered: Recovered) -> list[Hypothesis]:
    """All there are for a printout."""
    inputs = other_inputs(recovered)
    return [
        *inputs,
        *_throughout(shown, inputs),
        *_other_programs(recovered),
        *_printed_otherwise(shown, recovered),
        *Machines(shown, recovered).all(),
        *exchanged(recovered),
    ]


def tried(shown: Printout, recovered: Recovered, every: Sequence[Hypothesis]) -> Iterator[Tried]:
    """What each leaves unexplained; of many replays only those that come near."""
    import numpy as np

    expected = expected_results(shown)
    replayed = nearest([one for one in every if one.outcome is None], expected, _REPLAYED)
    wrong: list[set[str]] = [set() for _ in replayed]
    if replayed:
        names = [one.name for one in expected]
        endings, columns = replays.run_columns([one.scene for one in replayed], [*names, "MUP"])
        for one in expected:
            texts, where = np.unique(columns[one.name], return_inverse=True)
            differs = np.array([one.cost(text) >= AGREES for text in texts.tolist()])[where]
            for index in np.flatnonzero(differs).tolist():
                wrong[index].add(one.name)
        for index, (hypothesis, ending, mu) in enumerate(
            zip(replayed, endings, columns["MUP"].tolist(), strict=True)
        ):
            if shown.ending is not None and ending != shown.ending:
                wrong[index].add("ENDING")
            printed = recovered.assumed.get("MUP")
            exchanged = any(change.field == "MUP" for change in hypothesis.changes)
            if printed is not None and not exchanged and mu != printed:
                wrong[index].add("MUP")
    for hypothesis, names_wrong in zip(replayed, wrong, strict=True):
        yield Tried(hypothesis, hypothesis.scene, frozenset(names_wrong))
    for hypothesis in every:
        if hypothesis.outcome is not None:
            yield Tried(hypothesis, hypothesis.scene, _differing(shown, expected, hypothesis))


def _differing(
    shown: Printout, expected: Sequence[Expected], hypothesis: Hypothesis
) -> frozenset[str]:
    assert hypothesis.outcome is not None
    fields = hypothesis.outcome.fields
    wrong = {
        one.name
        for one in expected
        if one.name not in hypothesis.spared and one.cost(fields.get(one.name, "")) >= AGREES
    }
    for name in INPUTS:
        reading = shown.fields.get(name)
        if reading is None or name in hypothesis.spared or not reading.clean:
            continue
        if fields.get(name) != reading.text and value_of(fields.get(name, "")) != value_of(
            reading.text
        ):
            wrong.add(name)
    if shown.ending is not None and shown.ending != hypothesis.outcome.ending:
        wrong.add("ENDING")
    return frozenset(wrong)


def _printed_otherwise(shown: Printout, recovered: Recovered) -> Iterator[Hypothesis]:
    """The program's own results, printed otherwise; with speeds in another unit throughout."""
    known = all(reading.clean for reading in shown.fields.values())
    note = NOT_APPLESOFT if known else ""
    for scene in _either_sign(recovered.scene):
        outcome, values = replays.run_whole(scene)
        yield from Prints(shown, scene, outcome, values, note).all()


def _throughout(shown: Printout, inputs: Sequence[Hypothesis]) -> Iterator[Hypothesis]:
    """Speeds, or spins, in another unit both where they were put in and where they come out."""
    spared = frozenset((*SPEEDS, *SPINS))
    for one in inputs:
        if one.kind != UNITS or not one.note.endswith("shown so"):
            continue
        what = one.note.partition(",")[0]
        names = {change.field for change in one.changes}
        if not names <= spared or not _has_printed_energy(shown, one.scene):
            continue
        outcome, values = replays.run_whole(one.scene)
        for made in Prints(shown, one.scene, outcome, values).other_units():
            if made.note == what:
                note = f"{what}, inputs and results"
                yield made._replace(
                    kind=UNITS, note=note, changes=one.changes, spared=frozenset(names)
                )


def _has_printed_energy(shown: Printout, scene: dict[str, str]) -> bool:
    """Whether a scene's kinetic energy is the printed one, roughly."""
    printed = shown.fields.get("KI")
    value = value_of(printed.text) if printed is not None else None
    return value is not None and abs(float(value) - energy(scene)) <= _ROUGHLY * energy(scene)


def _other_programs(recovered: Recovered) -> Iterator[Hypothesis]:
    """Other values of M, and the sign of MU."""
    scene = recovered.scene
    other = "4" if scene["M"] == "6" else "6"
    change = (Change(OTHER_M, "M", scene["M"], other),)
    yield Hypothesis(OTHER_M, "", PROGRAM, change, {**scene, "M": other})
    for flipped in with_opposite_mu(scene):
        yield Hypothesis(MU_SIGN, "typed with the other sign", 1.2, (), flipped)
    if any(double(scene[name] or "0") for name in ("DA", "DB")):
        run = {**scene, "M": "4", "DA": "0", "DB": "0"}
        note = "as if computed with DA = DB = 0, though the printout shows others"
        yield Hypothesis(POINT_MASS, note, PROGRAM, (), run)


def _either_sign(scene: dict[str, str]) -> Iterator[dict[str, str]]:
    yield scene
    yield from with_opposite_mu(scene)


__all__ = ["Hypothesis", "Tried", "hypotheses", "tried"]
