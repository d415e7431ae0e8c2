"""Random scene files and their exact base values, by rational arithmetic of their own."""

import math
import random
from fractions import Fraction

FOOT, POUND, GRAVITY = Fraction(3048, 10000), Fraction(45359237, 10**8), Fraction(980665, 10**5)
PI = Fraction("3.1415926535897932384626433832795028841971")
SLUG = POUND * GRAVITY / FOOT
KINDS = {
    "length": "DA DB",
    "speed": "UX UY VX VY",
    "mass": "MA MB",
    "inertia": "IA IB",
    "angle": "GA PA PB TA TB",
    "spin": "WA WB",
    "number": "E MU EM",
}
KIND = {name: kind for kind, names in KINDS.items() for name in names.split()}
UNITS = {
    "length": {"ft": FOOT, "in": FOOT / 12, "m": Fraction(1), "cm": Fraction(1, 100)},
    "speed": {
        "mph": Fraction(44704, 10**5),
        "ft/s": FOOT,
        "km/h": Fraction(10, 36),
        "m/s": Fraction(1),
    },
    "mass": {"lb": POUND, "slug": SLUG, "kg": Fraction(1), "N": 1 / GRAVITY},
    "inertia": {"lb-ft-s2": SLUG * FOOT**2, "lb ft2": POUND * FOOT**2, "kg m2": Fraction(1)},
    "angle": {"deg": Fraction(1), "rad": 180 / PI},
    "spin": {"rad/s": Fraction(1), "deg/s": PI / 180, "rpm": PI / 30},
    "number": {},
}
"""Sizes in m, kg, s, degrees and rad/s."""
SHOWN = {
    "us": {"length": "ft", "speed": "mph", "mass": "lb", "inertia": "lb-ft-s2"},
    "chapter": {"length": "ft", "speed": "ft/s", "mass": "slug", "inertia": "lb-ft-s2"},
    "metric": {"length": "m", "speed": "km/h", "mass": "kg", "inertia": "kg m2"},
    "si": {"length": "m", "speed": "m/s", "mass": "kg", "inertia": "kg m2"},
}
RANGES = {"length": (1, 9), "speed": (-60, 60), "mass": (1000, 5000), "inertia": (800, 4000)}
RANGES |= {"angle": (-180, 180), "spin": (-3, 3), "number": (0, 1)}
MIRRORED = "UY VY WA WB GA PA PB".split()
VIEWS = [
    (system, axes, headings)
    for system in SHOWN
    for axes in ("", "sae")
    for headings in ("", "compass")
]
NOTATIONS = 9


def base_map(
    name: str, unit: str, system: str, axes: str, headings: str
) -> tuple[Fraction, Fraction]:
    """Return factor and offset of base = offset + factor * shown."""
    kind = KIND[name]
    feet = system in ("us", "chapter")
    length, mass = (FOOT, SLUG) if feet else (Fraction(1), Fraction(1))
    base = {"length": length, "speed": length, "mass": mass, "inertia": mass * length**2}
    usual = {"angle": "deg", "spin": "rad/s", **SHOWN[system]}.get(kind, "")
    size = UNITS[kind].get(unit or usual, Fraction(1)) / base.get(kind, Fraction(1))
    if headings and name in ("TA", "TB"):
        return -size, Fraction((0 if axes else 90) + (180 if name == "TA" else 0))
    return (-size if axes and (name in MIRRORED or name in ("TA", "TB")) else size), Fraction(0)


def entry(
    rng: random.Random, name: str, notation: int, view: tuple[str, str, str]
) -> tuple[str, tuple[Fraction | float, ...]]:
    """Return a text of a notation, and its exact value, low, high and standard deviation."""
    kind = KIND[name]
    places = rng.choice((0, 1, 3, 6))
    a, b, c = sorted(Fraction(f"{rng.uniform(*RANGES[kind]):.{places}f}") for _ in range(3))
    width = Fraction(f"{rng.uniform(0.1, (RANGES[kind][1] - RANGES[kind][0]) / 20):.2f}")
    unit = rng.choice(("", *UNITS[kind]))
    behind = f" {unit}" if unit else ""

    def text(number: Fraction) -> str:
        return f"{float(number):.{max(places, 2)}f}"

    numbers: tuple[Fraction | float, ...] = (b, b, b, Fraction(0))
    words = text(b) + behind
    if notation == 1:
        words, numbers = f"{text(a)} .. {text(c)}{behind}", ((a + c) / 2, a, c, Fraction(0))
    elif notation == 2:
        words, numbers = (
            f"{text(b)} +- {text(width)}{behind}",
            (b, b - width, b + width, Fraction(0)),
        )
    elif notation == 3:
        half = abs(b) * width / 100
        words, numbers = (
            f"{text(b)}{behind} ± {text(width)} %",
            (b, b - half, b + half, Fraction(0)),
        )
    elif notation == 4:
        words = f"normal {text(b)} {text(width)}{behind}"
        numbers = (b, -math.inf, math.inf, width)
    elif notation == 5:
        words, numbers = f"triangular {text(a)} {text(b)} {text(c)}{behind}", (b, a, c, Fraction(0))
    elif notation == 6:
        words, numbers = f"uniform {text(a)} {text(c)}{behind}", ((a + c) / 2, a, c, Fraction(0))
    elif notation == 7 and kind == "length":
        words, b = f"{int(abs(a))} ft 6 in", int(abs(a)) + Fraction(1, 2)
        unit, numbers = "ft", (b, b, b, Fraction(0))
    elif notation == 8 and kind == "mass" and b >= 1000:
        whole = Fraction(int(b))
        words, unit = f"{int(b):,} lb", "lb"
        numbers = (whole, whole, whole, Fraction(0))
    factor, offset = base_map(name, unit, *view)
    value, low, high = (
        x * (1 if factor > 0 else -1) if isinstance(x, float) else offset + factor * x
        for x in numbers[:3]
    )
    if factor < 0:
        low, high = high, low
    return words, (value, low, high, abs(factor) * Fraction(numbers[3]))


def scene_file(
    seed: int,
) -> tuple[str, tuple[str, str, str], dict[str, tuple[Fraction | float, ...]]]:
    """Return a random scene file, its view, and its exact base values by name."""
    rng = random.Random(seed)
    view = VIEWS[seed % len(VIEWS)]
    lines = [
        f'{word} = "{text}"'
        for word, text in zip(("units", "axes", "headings"), view, strict=True)
        if text
    ]
    exact = {}
    for name in KIND:
        words, exact[name] = entry(rng, name, rng.randrange(NOTATIONS), view)
        lines.append(f'{name} = "{words}"')
    return "\n".join(lines), view, exact
