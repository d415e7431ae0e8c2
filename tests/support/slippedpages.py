"""Pages with one known cause each, made from captured runs without the package's help.

Each maker takes a captured run and returns the page and what the cause is, or None where this run
cannot show it. Slips are done to the captured text; other units, places and angles too, where what
the machine computed with is the capture's own; other machines compute in `machines`.
"""

from __future__ import annotations

import math
import random
import re
from collections.abc import Callable, Iterator, Mapping
from decimal import Decimal
from typing import Any, NamedTuple

import machines

import printouts
from impact88.collision.fields import ANGLES, INPUTS
from impact88.printouts.explaining.causes import Cause

Row = dict[str, Any]
Named = Callable[[Cause], bool]


class Slipped(NamedTuple):
    """A page, what is wrong with it in words, and whether an explanation says just that."""

    text: str
    cause: str
    named: Named


Maker = Callable[[Row, random.Random], Slipped | None]

_RESULTS = "XA YA XB YB KI LOSS VAX VAY XAF YAF VBX VBY XBF YBF WAF WBF".split()


def texts(row: Row) -> tuple[str, dict[str, str]]:
    """A captured page without its prompts, and its numbers."""
    text = printouts.body(row["printout"])
    return text, {one.name: text[one.start : one.stop] for one in printouts.places(text)}


def replaced(text: str, new: Mapping[str, str]) -> str:
    """The page with other numbers in some places."""
    for place in reversed(printouts.places(text)):
        if place.name in new:
            text = text[: place.start] + new[place.name] + text[place.stop :]
    return text


def _changes(one: Cause) -> set[tuple[str | None, str | None]]:
    if one.changes:
        return {(change["field"], change["would_be"]) for change in one.changes}
    return {(one.field, one.would_be)}


def _puts_right(true: Mapping[str, str]) -> Named:
    """Whether just these numbers are put right, as they were; fewer where that explains all, for
    then nothing on the page depends on the others."""
    wanted = {(name, Decimal(text)) for name, text in true.items()}

    def named(one: Cause) -> bool:
        said = {(name, Decimal(text or "NaN")) for name, text in _changes(one) if name is not None}
        return said == wanted or (bool(said) and said < wanted and not one.remaining)

    return named


def _is(*kinds: str) -> Named:
    return lambda one: one.kind in kinds


def _slipped(text: str, true: Mapping[str, str], new: Mapping[str, str]) -> Slipped:
    cause = "; ".join(f"{name} {new[name]} for {true[name]}" for name in new)
    return Slipped(replaced(text, new), cause, _puts_right({name: true[name] for name in new}))


# --- misread and mistyped digits ---


def _other_digits(text: str, count: int, rng: random.Random) -> str | None:
    places = [place for place, char in enumerate(text.partition("E")[0]) if char.isdigit()]
    if len(places) < count:
        return None
    glyphs = list(text)
    for place in rng.sample(places, count):
        glyphs[place] = rng.choice([digit for digit in "0123456789" if digit != glyphs[place]])
    other = "".join(glyphs)
    return other if _written_so(other) else None


def _written_so(text: str) -> bool:
    """Whether the program could write so: no needless zero."""
    size = text.removeprefix("-").partition("E")[0]
    whole, point, decimals = size.partition(".")
    return not (
        (len(size) > 1 and whole.startswith("0"))
        or (point and decimals.endswith("0"))
        or size == "."
    )


def two_digits(row: Row, rng: random.Random) -> Slipped | None:
    """Two wrong digits in one input."""
    text, true = texts(row)
    name = rng.choice(INPUTS)
    other = _other_digits(true[name], 2, rng)
    return other and _slipped(text, true, {name: other})


def two_inputs(row: Row, rng: random.Random) -> Slipped | None:
    """One wrong digit in each of two inputs."""
    text, true = texts(row)
    new = {name: _other_digits(true[name], 1, rng) for name in rng.sample(INPUTS, 2)}
    return None if None in new.values() else _slipped(text, true, new)


def _sign(text: str) -> str | None:
    if text == "0":
        return None
    return text[1:] if text.startswith("-") else "-" + text


def _adjacent(text: str, rng: random.Random) -> str | None:
    pairs = [
        place
        for place in range(len(text) - 1)
        if text[place].isdigit() and text[place + 1].isdigit() and text[place] != text[place + 1]
    ]
    if not pairs or "E" in text:
        return None
    place = rng.choice(pairs)
    other = text[:place] + text[place + 1] + text[place] + text[place + 2 :]
    return other if _written_so(other) else None


def _point(text: str, rng: random.Random) -> str | None:
    if "." not in text or "E" in text:
        return None
    digits, place = text.replace(".", ""), text.index(".")
    other = digits[: place + 1] + "." + digits[place + 1 :]
    other = other.removesuffix(".")
    return other if _written_so(other) and other != text else None


def input_and_result(row: Row, rng: random.Random) -> Slipped | None:
    """A wrong digit in an input and one in a result."""
    text, true = texts(row)
    results = [name for name in _RESULTS if name in true]
    names = (rng.choice(INPUTS), rng.choice(results))
    new = {name: _other_digits(true[name], 1, rng) for name in names}
    return None if None in new.values() else _slipped(text, true, new)


def two_kinds(row: Row, rng: random.Random) -> Slipped | None:
    """A sign, a point or two neighbouring digits in one input, a wrong digit in another."""
    text, true = texts(row)
    one, other = rng.sample(INPUTS, 2)
    way = rng.choice((lambda t, _: _sign(t), _adjacent, _point))
    new = {one: way(true[one], rng), other: _other_digits(true[other], 1, rng)}
    return None if None in new.values() else _slipped(text, true, new)  # type: ignore[arg-type]


def swap_and_digit(row: Row, rng: random.Random) -> Slipped | None:
    """A's and B's number in each other's place, and a wrong digit in another input."""
    text, true = texts(row)
    one, two = rng.choice(_PAIRS)
    third = rng.choice([name for name in INPUTS if name not in (one, two)])
    wrong = _other_digits(true[third], 1, rng)
    if true[one] == true[two] or wrong is None:
        return None
    return _slipped(text, true, {one: true[two], two: true[one], third: wrong})


# --- in each other's place ---

_PAIRS = (
    ("MA", "MB"), ("IA", "IB"), ("DA", "DB"), ("PA", "PB"), ("TA", "TB"), ("WA", "WB"),
    ("UX", "VX"), ("UY", "VY"),
)  # fmt: skip
_LINES = (("VAX", "VBX"), ("VAY", "VBY"), ("XAF", "XBF"), ("YAF", "YBF"))
_XY = (("VAX", "VAY"), ("VBX", "VBY"), ("XAF", "YAF"), ("XBF", "YBF"))


def _exchanged(row: Row, pairs: tuple[tuple[str, str], ...]) -> Slipped | None:
    text, true = texts(row)
    new = {}
    for one, two in pairs:
        if true[one] != true[two]:
            new |= {one: true[two], two: true[one]}
    return _slipped(text, true, new) if new else None


def sides(row: Row, rng: random.Random) -> Slipped | None:
    """A's and B's input in each other's place: one pair, or all of some."""
    some = rng.choice((*((pair,) for pair in _PAIRS), _PAIRS[:2], _PAIRS[6:], _PAIRS[3:5], _PAIRS))
    return _exchanged(row, some)


def axes(row: Row, rng: random.Random) -> Slipped | None:
    """x and y in each other's place, of A's or B's velocity or both."""
    return _exchanged(
        row, rng.choice(((("UX", "UY"),), (("VX", "VY"),), (("UX", "UY"), ("VX", "VY"))))
    )


def result_places(row: Row, rng: random.Random) -> Slipped | None:
    """Results in each other's place: A and B, or x and y, of one pair or all."""
    groups = ((_LINES[0],), (_LINES[1],), (("WAF", "WBF"),), _LINES, (_XY[0],), (_XY[1],), _XY)
    some = rng.choice(groups)
    return _exchanged(row, tuple(pair for pair in some if pair[0] in texts(row)[1]))


# --- angles and units ---


def _shown(value: float, places: int | None = None) -> str:
    """As the program writes it."""
    return machines.in_full(9)(value if places is None else round(value, places))


def _alike(names: tuple[str, ...], kinds: tuple[str, ...]) -> Named:
    """Whether just these inputs are put right, as a cause of such a kind."""
    return lambda one: one.kind in kinds and {name for name, _ in _changes(one)} == set(names)


def radians(row: Row, rng: random.Random) -> Slipped | None:
    """Angles that stand on the page in radians, to three or four decimals or in full."""
    text, true = texts(row)
    names = rng.choice((*((name,) for name in ANGLES), ANGLES))
    names = tuple(name for name in names if float(true[name]))
    places = rng.choice((3, 4, None))
    new = {name: _shown(math.radians(float(row["scene"][name])), places) for name in names}
    if not new:
        return None
    cause = f"{', '.join(names)} in radians, {places} decimals"
    return Slipped(replaced(text, new), cause, _alike(names, ("angle in radians",)))


_SPEEDS = ("UX", "UY", "VX", "VY")
UNITS: tuple[tuple[str, tuple[str, ...], float, tuple[int | None, ...]], ...] = (
    ("mph for ft/s", _SPEEDS, 15 / 22, (2, 3, None)),
    ("km/h for m/s", _SPEEDS, 3.6, (1, 2, None)),
    ("ft/s for mph", _SPEEDS, 22 / 15, (2, 3, None)),
    ("km/h for ft/s", _SPEEDS, 1.09728, (2, 3, None)),
    ("knots for ft/s", _SPEEDS, 1 / 1.687810, (2, 3, None)),
    ("weights for masses", ("MA", "MB"), 32.174, (0, 1, None)),
    ("weights for masses, 32.2", ("MA", "MB"), 32.2, (0, 1, None)),
    ("kgf for masses", ("MA", "MB"), 9.81, (1, 2, None)),
    ("weights for masses and inertias", ("MA", "MB", "IA", "IB"), 32.2, (0, 1, None)),
    ("inertias by weight", ("IA", "IB"), 32.174, (0, 1, None)),
    ("inches for feet", ("DA", "DB"), 12.0, (1, 2, None)),
    ("feet for meters", ("DA", "DB"), 1 / 0.3048, (2, 3, None)),
    ("degrees for radians a second", ("WA", "WB"), 180 / math.pi, (1, 2, None)),
    ("turns a minute", ("WA", "WB"), 30 / math.pi, (1, 2, None)),
    ("percent", ("E",), 100.0, (None,)),
)
"""What is shown in another unit, times what, to how many decimals."""


def units(row: Row, rng: random.Random) -> Slipped | None:
    """Inputs that stand on the page in another unit than was computed with."""
    text, true = texts(row)
    what, names, factor, decimals = rng.choice(UNITS)
    names = tuple(name for name in names if float(true[name]))
    places = rng.choice(decimals)
    new = {name: _shown(float(row["scene"][name]) * factor, places) for name in names}
    if not new:
        return None
    return Slipped(
        replaced(text, new), f"{what}, {places} decimals", _alike(names, ("another unit",))
    )


_FT = 0.3048
_ALL_SPEEDS = tuple(n for pair in (*_LINES, ("XA", "XB"), ("YA", "YB")) for n in pair)
RESULT_UNITS = (
    ("speeds in mph", _ALL_SPEEDS, 15 / 22),
    ("speeds in m/s", _ALL_SPEEDS, _FT),
    ("final speeds in mph", _ALL_SPEEDS[:8], 15 / 22),
    ("final speeds in km/h", _ALL_SPEEDS[:8], 1.09728),
    ("final spins in degrees", ("WAF", "WBF"), 180 / math.pi),
    ("final spins in turns a minute", ("WAF", "WBF"), 30 / math.pi),
)


def result_units(row: Row, rng: random.Random) -> Slipped | None:
    """Results that stand on the page in another unit, floored to the listing's decimals."""
    what, names, factor = rng.choice(RESULT_UNITS)
    values = _captured_values(row)
    text, true = texts(row)
    new = {
        name: machines.in_full(9)(machines.floored(values[name] * factor, machines.PLACES[name]))
        for name in names
        if name in true
    }
    if not any(float(true[name]) for name in new):
        return None
    return Slipped(replaced(text, new), what, _is("results in another unit"))


# --- other machines and other ways to print ---


def _captured_values(row: Row) -> dict[str, float]:
    """What the real machine had in its variables when it ended, before INT."""

    def of(stored: str) -> float:
        data = bytes.fromhex(stored)
        if not data[0]:
            return 0.0
        mantissa = int.from_bytes(bytes([data[1] | 0x80]) + data[2:5], "big")
        return math.ldexp(-mantissa if data[1] & 0x80 else mantissa, data[0] - 128 - 32)

    value = {name: of(stored) for name, stored in row["reals"].items()}
    size = row["A"]["dims"][0]
    column = int(value["M"]) + 1
    end = [of(row["A"]["data"][k + size * column]) for k in range(1, 7)]
    return {
        "XA": value["UX"] + value["D3"] * value["WA"],
        "YA": value["UY"] - value["D4"] * value["WA"],
        "XB": value["VX"] - value["D1"] * value["WB"],
        "YB": value["VY"] + value["D2"] * value["WB"],
        "LOSS": 100 * (value["KI"] - value["KF"]) / value["KI"],
        **{f"{name}F": value[name] for name in ("XA", "YA", "XB", "YB")},
        **dict(zip(("VAX", "VAY", "VBX", "VBY"), end, strict=False)),
        **({"WAF": end[4], "WBF": end[5]} if value["M"] == value["N"] else {}),
    }


def _same_numbers(one: str, other: str) -> bool:
    def numbers(text: str) -> list[Decimal]:
        return [Decimal(text[place.start : place.stop]) for place in printouts.places(text)]

    return numbers(one) == numbers(other)


def _recut(row: Row, cut: Callable[[Any, int], Decimal], more: int = 0) -> str | None:
    """The captured page, its results cut otherwise."""
    text, true = texts(row)
    write = machines.in_full(9)
    new = {
        name: write(cut(value, machines.PLACES[name] + more))
        for name, value in _captured_values(row).items()
        if name in true
    }
    page = replaced(text, new)
    return None if _same_numbers(page, text) else page


def rounding(row: Row, rng: random.Random) -> Slipped | None:
    """The machine's own results rounded, not floored."""
    page = _recut(row, machines.rounded)
    return page and Slipped(page, "rounded", _is("rounded, not floored"))


def truncation(row: Row, rng: random.Random) -> Slipped | None:
    """The machine's own results cut toward zero, not floored."""
    page = _recut(row, machines.truncated)
    return page and Slipped(page, "truncated", _is("truncated, not floored"))


def more_decimals(row: Row, rng: random.Random) -> Slipped | None:
    """The machine's own results to more decimals, floored or rounded."""
    page = _recut(row, rng.choice((machines.floored, machines.rounded)), rng.choice((1, 2, 3)))
    return page and Slipped(page, "more decimals", _is("printed with other decimals"))


def fewer_decimals(row: Row, rng: random.Random) -> Slipped | None:
    """The machine's own results to fewer decimals."""
    page = _recut(row, machines.rounded, rng.choice((-1, -2)))
    return page and Slipped(page, "fewer decimals", _is("printed with other decimals"))


def _computed(row: Row, machine: machines.Machine, named: Named, **how: Any) -> Slipped | None:
    try:
        values = machines.computed(row["scene"], machine)
        if not all(map(math.isfinite, map(float, values.values()))):
            return None
        page = machines.page(values, digits=machine.digits, **how)
    except (machines.Stopped, OverflowError, ArithmeticError):
        return None
    if _same_numbers(page, texts(row)[0]):
        return None
    return Slipped(page, machine.name, named)


def double(row: Row, rng: random.Random) -> Slipped | None:
    """IEEE double, floored as the listing does."""
    return _computed(row, machines.DOUBLE, _is("IEEE double arithmetic"))


def double_long(row: Row, rng: random.Random) -> Slipped | None:
    """IEEE double that prints as many digits as it has."""
    machine = machines.DOUBLE._replace(digits=16)
    return _computed(row, machine, _is("IEEE double arithmetic"))


def exact_pi(row: Row, rng: random.Random) -> Slipped | None:
    """IEEE double with pi to all its digits."""
    return _computed(row, machines.DOUBLE_PI, _is("IEEE double arithmetic with exact pi"))


def rough_pi(row: Row, rng: random.Random) -> Slipped | None:
    """IEEE double with pi = 3.1416."""
    return _computed(row, machines.ROUGH_PI, _is("IEEE double arithmetic with pi = 3.1416"))


def double_rounded(row: Row, rng: random.Random) -> Slipped | None:
    """IEEE double, rounded."""
    machine = rng.choice((machines.DOUBLE, machines.DOUBLE_PI))
    return _computed(
        row, machine, _is("IEEE double arithmetic, rounded, not floored"), cut=machines.rounded
    )


def double_truncated(row: Row, rng: random.Random) -> Slipped | None:
    """IEEE double, cut toward zero."""
    return _computed(
        row,
        machines.DOUBLE,
        _is("IEEE double arithmetic, truncated, not floored"),
        cut=machines.truncated,
    )


def single(row: Row, rng: random.Random) -> Slipped | None:
    """Single precision of four kinds, in the Apple's layout or Microsoft's."""
    machine = machines.SINGLES[rng.choice(list(machines.SINGLES))]
    return _computed(row, machine, _is("single-precision arithmetic"), spaced=rng.random() < 0.5)


def single_rounded(row: Row, rng: random.Random) -> Slipped | None:
    """The same, rounded."""
    machine = machines.SINGLES[rng.choice(list(machines.SINGLES))]
    return _computed(
        row,
        machine,
        _is("single-precision arithmetic, rounded, not floored"),
        cut=machines.rounded,
        spaced=rng.random() < 0.5,
    )


def bcd(row: Row, rng: random.Random) -> Slipped | None:
    """Decimal machines of ten, twelve and fourteen digits."""
    machine = machines.decimal(
        rng.choice((10, 12, 14)), rng.choice(("ROUND_HALF_UP", "ROUND_DOWN"))
    )
    return _computed(row, machine, _is("another arithmetic", "IEEE double arithmetic"))


CLASSES: dict[str, Maker] = {
    "two wrong digits in one input": two_digits,
    "A and B in each other's place": sides,
    "x and y in each other's place": axes,
    "results in each other's place": result_places,
    "angles in radians": radians,
    "two wrong inputs": two_inputs,
    "a wrong input and a wrong result": input_and_result,
    "two slips of two kinds": two_kinds,
    "A and B exchanged, and a wrong digit": swap_and_digit,
    "inputs in another unit": units,
    "results in another unit": result_units,
    "rounded": rounding,
    "truncated": truncation,
    "more decimals": more_decimals,
    "fewer decimals": fewer_decimals,
    "IEEE double": double,
    "IEEE double, all digits": double_long,
    "IEEE double, exact pi": exact_pi,
    "IEEE double, pi = 3.1416": rough_pi,
    "IEEE double, rounded": double_rounded,
    "IEEE double, truncated": double_truncated,
    "single precision": single,
    "single precision, rounded": single_rounded,
    "decimal machines": bcd,
}


# --- pages nothing single explains ---


def many_wrong(row: Row, rng: random.Random) -> str | None:
    """Wrong digits in four to eight numbers, two of them inputs at least."""
    text, true = texts(row)
    results = [name for name in _RESULTS if name in true]
    names = rng.sample(INPUTS, rng.randint(2, 4)) + rng.sample(results, rng.randint(2, 4))
    new = {name: other for name in names if (other := _other_digits(true[name], 1, rng))}
    return replaced(text, new) if len(new) >= 4 else None


def drifted(row: Row, rng: random.Random) -> str | None:
    """Every result of another scene: all inputs of one vehicle are a little off."""
    text, true = texts(row)
    new = {}
    for name in [name for name in _RESULTS if name in true]:
        value = float(true[name]) * rng.uniform(0.9, 1.1) + rng.uniform(-1, 1)
        new[name] = _shown(value, machines.PLACES.get(name))
    return replaced(text, new)


def three_inputs(row: Row, rng: random.Random) -> str | None:
    """Three inputs that have nothing to do with what was computed."""
    text, true = texts(row)
    names = [name for name in INPUTS if float(true[name])]
    if len(names) < 3:
        return None
    new = {
        name: _shown(float(true[name]) * rng.uniform(0.5, 2), 2) for name in rng.sample(names, 3)
    }
    return replaced(text, new)


UNEXPLAINED: dict[str, Callable[[Row, random.Random], str | None]] = {
    "four to eight wrong numbers": many_wrong,
    "results all a little off": drifted,
    "three inputs of another scene": three_inputs,
}


def made(
    maker: Callable[[Row, random.Random], Any], rows: list[Row], count: int, seed: int
) -> Iterator[tuple[Row, Any]]:
    """So many pages of one kind, of rows drawn at random."""
    rng = random.Random(seed)
    order = rng.sample(rows, len(rows))
    for row in order:
        page = maker(row, rng)
        if page:
            yield row, page
            count -= 1
            if not count:
                return


PLAIN = re.compile(r"-?[0-9.]+")


def ordinary(rows: list[Row]) -> list[Row]:
    """Full solutions (M = 6) of which no input is written with an exponent past a thousandth."""
    return [
        row
        for row in rows
        if row["scene"]["M"] == "6"
        and all(abs(float(text)) < 1e6 for text in row["scene"].values())
        and all(float(row["scene"][name]) >= 1e-3 for name in ("MA", "MB", "IA", "IB"))
    ]
