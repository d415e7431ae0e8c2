"""Every number of random files is what rational arithmetic gives, and is shown as written."""

import math
import random
from fractions import Fraction

import numpy as np
import pytest

from impact88.cases import Case

FOOT, POUND, GRAVITY = map(Fraction, ("0.3048", "0.45359237", "9.80665"))  # m, kg, m/s²
PI = Fraction("3.1415926535897932384626433832795028841971")
SLUG = POUND * GRAVITY / FOOT
KINDS = {
    "length": ("DA DB", (1, 9), {"ft": FOOT, "in": FOOT / 12, "m": 1}),
    "speed": ("UX UY VX VY", (-60, 60), {"mph": FOOT * 22 / 15, "ft/s": FOOT, "m/s": 1}),
    "mass": ("MA MB", (1000, 5000), {"lb": POUND, "slug": SLUG, "kg": 1, "N": 1 / GRAVITY}),
    "inertia": ("IA IB", (800, 4000), {"lb-ft-s2": SLUG * FOOT**2, "lb ft2": POUND * FOOT**2}),
    "angle": ("GA PA PB TA TB", (-180, 180), {"deg": 1, "rad": 180 / PI}),
    "spin": ("WA WB", (-3, 3), {"rad/s": 1, "deg/s": PI / 180, "rpm": PI / 30}),
    "number": ("E MU EM", (0, 1), {}),
}
"""Names, range of values, and sizes of units in m, kg, s, degrees and rad/s."""
KINDS["speed"][2]["km/h"] = Fraction(10, 36)
KINDS["inertia"][2]["kg m2"] = 1
KIND = {name: kind for kind, (names, *_) in KINDS.items() for name in names.split()}
SHOWN = {
    "us": {"length": "ft", "speed": "mph", "mass": "lb", "inertia": "lb-ft-s2"},
    "chapter": {"length": "ft", "speed": "ft/s", "mass": "slug", "inertia": "lb-ft-s2"},
    "metric": {"length": "m", "speed": "km/h", "mass": "kg", "inertia": "kg m2"},
    "si": {"length": "m", "speed": "m/s", "mass": "kg", "inertia": "kg m2"},
}
MIRRORED = "UY VY WA WB GA PA PB TA TB".split()
VIEWS = [(system, axes, way) for system in SHOWN for axes in ("", "sae") for way in ("", "compass")]


def base_map(name, unit, view):
    """Return factor and offset of base = offset + factor * shown."""
    kind, (system, axes, headings) = KIND[name], view
    length, mass = (FOOT, SLUG) if system in ("us", "chapter") else (Fraction(1), Fraction(1))
    base = {"length": length, "speed": length, "mass": mass, "inertia": mass * length**2}
    symbol = unit or {"angle": "deg", "spin": "rad/s", **SHOWN[system]}.get(kind, "")
    size = KINDS[kind][2].get(symbol, 1) / base.get(kind, Fraction(1))
    if headings and name in ("TA", "TB"):
        return -size, Fraction((0 if axes else 90) + (180 if name == "TA" else 0))
    return (-size if axes and name in MIRRORED else size), Fraction(0)


def notation_of(rng, name, notation):
    """Return a text, its unit, and its exact value, low, high and standard deviation."""
    _, limits, units = KINDS[KIND[name]]
    texts = [f"{rng.uniform(*limits):.{rng.choice((0, 1, 3, 6))}f}" for _ in range(3)]
    low, middle, high = sorted(texts, key=Fraction)
    a, b, c = map(Fraction, (low, middle, high))
    width = f"{rng.uniform(0.1, (limits[1] - limits[0]) / 20):.2f}"
    unit = rng.choice(("", *units))
    end = f" {unit}" if unit else ""
    half = Fraction(width) * (abs(b) / 100 if notation == 3 else 1)
    if notation in (1, 6):
        words = f"{low} .. {high}{end}" if notation == 1 else f"uniform {low} {high}{end}"
        return words, unit, ((a + c) / 2, a, c, 0)
    if notation in (2, 3):
        words = f"{middle} +- {width}{end}" if notation == 2 else f"{middle}{end} ± {width} %"
        return words, unit, (b, b - half, b + half, 0)
    if notation == 4:
        return f"normal {middle} {width}{end}", unit, (b, -math.inf, math.inf, half)
    if notation == 5:
        return f"triangular {low} {middle} {high}{end}", unit, (b, a, c, 0)
    words = middle + end
    if notation == 7 and KIND[name] == "length":
        words, unit, b = f"{int(b)} ft 6 in", "ft", int(b) + Fraction(1, 2)
    elif notation == 8 and KIND[name] == "mass":
        words, unit, b = f"{int(b):,} lb", "lb", Fraction(int(b))
    return words, unit, (b, b, b, 0)


def scene_file(seed):
    """Return a random scene file and its exact base values by name."""
    rng, view, exact = random.Random(seed), VIEWS[seed % len(VIEWS)], {}
    pairs = zip(("units", "axes", "headings"), view, strict=True)
    lines = [f'{word} = "{text}"' for word, text in pairs if text]
    for name in KIND:
        words, unit, (value, *ends, sd) = notation_of(rng, name, rng.randrange(9))
        factor, offset = base_map(name, unit, view)
        value, *ends = (offset + factor * x if math.isfinite(x) else x for x in (value, *ends))
        exact[name] = (value, min(ends), max(ends), abs(factor) * sd)
        lines.append(f'{name} = "{words}"')
    return "\n".join(lines), exact


@pytest.mark.parametrize("seed", range(2 * len(VIEWS)))
def test_entries_are_exact_and_shown_as_written(seed: int) -> None:
    text, exact = scene_file(seed)
    case = Case.loads(text)
    for name, numbers in exact.items():
        amount = case.entries[name]
        read = amount.value, amount.low, amount.high, amount.sd
        for is_, exact_number in zip(read, numbers, strict=True):
            assert math.isclose(is_, exact_number, rel_tol=1e-12, abs_tol=1e-300), (name, text)

        base, view = float(numbers[0]), case.view
        factor, offset = view.map(name)
        shown = (Fraction(base) - offset) / factor
        turn = 360 if view.headings and name in ("TA", "TB") else math.inf
        largest = max(abs(base), abs(offset)) if offset else 0
        allowed = 2 * math.ulp(float(max(abs(shown), largest)))
        for number in (view.shown(name, base), view.shown(name, np.array([base, base]))[1]):
            assert abs(math.remainder(float(Fraction(float(number)) - shown), turn)) <= allowed
        value = Case.of({name: view.shown(name, base)}, view=view).entries[name].value
        allowed = 2 * math.ulp(float(max(abs(base), largest)))
        assert abs(math.remainder(value - base, turn)) <= allowed
