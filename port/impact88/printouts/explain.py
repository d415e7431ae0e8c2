"""Explanation of a page that differs: a short list of causes, each tested by computing the page.

A cause changes the scene, or the arithmetic. It is offered if it prints all but a few of the
numbers that differ.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from decimal import Decimal

import numpy as np

from ..program.arithmetics import FLOAT64, Arithmetic
from ..program.run import run
from .findings import Finding, Kind, Verification
from .numerals import opposite
from .page import INPUTS, RESULTS
from .reader import read_printouts
from .search import printed_fields
from .words import sentence_of

MAX_UNEXPLAINED = 0.25
"""Fraction of the numbers that differ which a cause may leave."""
MIN_NUMBERS = 3
"""Numbers that differ from which causes beyond single slips are tried."""
SINGLE_DIGITS = 7
"""Digits that single precision prints."""
SINGLE_ERROR = 1e-5
"""Relative difference of two computations in single precision: some hundred roundings."""
DOUBLE = "computed in double precision, not by an Apple"
SINGLE = "computed in single precision, not by an Apple"
NOT_COMPUTED = (
    "the numbers listed were not computed from these inputs; no other value of one input was found "
    "that explains them all (slips, and values no longer than those read, were tried)"
)
Scene = Mapping[str, str]


def explain(verification: Verification) -> str:
    """Return what explains a page that differs.

    Parameters
    ----------
    verification : Verification
        The page with its scene.

    Returns
    -------
    str
        One sentence, "" if nothing of the list explains it.
    """
    findings = [finding for finding in verification.findings if finding.kind is Kind.NUMBER]
    read = {finding.name: finding.read for finding in findings if finding.name in RESULTS}
    if len(read) >= MIN_NUMBERS:
        for cause, fields, error in _causes(verification):
            misses = [
                name
                for name, text in read.items()
                if not _agrees(fields.get(name, ""), text, error)
            ]
            if len(misses) <= MAX_UNEXPLAINED * len(read):
                return cause + (f"; but not {', '.join(misses)}" if misses else "")
        return NOT_COMPUTED
    slips = [_slip(verification, finding) for finding in findings]
    either = [
        f"{finding.name} {finding.read} (would be {finding.printed})"
        for finding in verification.findings
        if finding.kind is Kind.EITHER
    ]
    if either:
        slips.append(f"one of these is a slip, or edited later: {' or '.join(either)}")
    slips += [
        f"line {verification.line_of(finding.start)}: {sentence_of(finding)}"
        for finding in verification.findings
        if finding.kind is Kind.LABEL
    ]
    return "; ".join(slips) if len(slips) < MIN_NUMBERS else ""


def _slip(verification: Verification, finding: Finding) -> str:
    """Return the sentence on one number that differs from all others."""
    line = verification.line_of(finding.start)
    if finding.name not in INPUTS:
        return (
            f"line {line}: {finding.name} {finding.read} is not what the program prints for "
            f"the inputs ({finding.printed}); a slip, or edited later"
        )
    if finding.name == "MUP" and finding.read == opposite(finding.printed):
        return f"line {line}: computed with the other sign of MU (line 400)"
    return (
        f"line {line}: {finding.name} {finding.read} is a slip, or edited later: everything else "
        f"was computed with {finding.printed}"
    )


def _causes(verification: Verification) -> Iterator[tuple[str, Mapping[str, str], float]]:
    """Yield each cause, the numbers that it prints, and their relative error."""
    scene = verification.scene
    changed_m = "4" if scene["M"] == "6" else "6"
    turned_scene = {**scene, "MU": opposite(scene["MU"])}
    yield (
        f"computed with M = {changed_m} (line 350)",
        printed_fields({**scene, "M": changed_m}),
        0.0,
    )
    yield "computed with the other sign of MU (line 400)", printed_fields(turned_scene), 0.0
    causes: list[tuple[str, Arithmetic, float]] = [(DOUBLE, FLOAT64, 0.0)]
    energy = verification.numbers["KI"]
    if _digits(energy.read) <= SINGLE_DIGITS:
        is_rounded = _digits(energy.printed) > SINGLE_DIGITS
        causes.insert(not is_rounded, (SINGLE, FLOAT32, SINGLE_ERROR))
    for cause, arithmetic, error in causes:
        yield cause, _run_in(scene, arithmetic), error


def _digits(text: str) -> int:
    """Return the number of digits of a number without zeros at its ends."""
    return sum(map(str.isdigit, text.partition("E")[0].strip("0.")))


def _run_in(scene: Scene, arithmetic: Arithmetic) -> Mapping[str, str]:
    """Return the numbers that the program prints in another arithmetic, by name."""
    readings = read_printouts(run(scene, arithmetic).page)
    return {name: slot.text for reading in readings for name, slot in reading.slots.items()}


def _agrees(printed: str, read: str, error: float) -> bool:
    """Return True for the same number, to the last place of the one with fewer."""
    try:
        first, second = Decimal(printed), Decimal("".join(read.split()))
    except ArithmeticError:
        return False
    places = max(int(number.as_tuple().exponent) for number in (first, second))
    unit = Decimal(1).scaleb(places)
    if not error:
        return first.quantize(unit) == second.quantize(unit)
    return abs(first - second) <= max(unit, abs(first) * Decimal(error))


def _round_single(x: float) -> float:
    return float(np.float32(x))


def _read_single(text: str, start: int) -> tuple[float, int]:
    value, end = FLOAT64.read(text, start)
    return _round_single(value), end


FLOAT32 = FLOAT64._replace(
    name="float32",
    read=_read_single,
    LET=_round_single,
    SIN=lambda x: _round_single(math.sin(x)),
    COS=lambda x: _round_single(math.cos(x)),
    write=lambda x: FLOAT64.write(float(f"{x or 0.0:.{SINGLE_DIGITS - 1}E}")),
)
"""Every number stored is rounded to 24 bits, as in GW-BASIC and its kind."""
