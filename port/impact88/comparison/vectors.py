"""Test vectors for other implementations: labelled scenes with everything the oracle knows.

Three classes in turn: ``casework`` (as reports hold them), ``edge`` (one limit or special case),
``failure`` (the 1988 program stops, or goes wrong without a word). Seed and number give the same
vector on any machine."""

from collections.abc import Callable, Iterator, Mapping
from itertools import count as count_from
from itertools import islice
from math import cos, radians, sin
from random import Random
from typing import Any

import numpy as np

from ..collision.doubles import doubles_of
from ..files import packaged_bytes
from ..mechanics.closedform.solve import solve
from ..messages.schemas import with_schema
from ..names import FINAL_VELOCITIES, SCENE
from .oracle import BATCH, oracle

Texts = dict[str, str]
_Range = tuple[float, float, int]
"""From, to, and the most places typed."""

CLASSES = CASEWORK, EDGE, FAILURE = "casework", "edge", "failure"
ANSWER, REFUSE, EITHER = "answer", "refuse", "either"

PUBLISHED, PUBLISHED_SEED = 1000, 1988
"""Every label occurs in 16 scenes at least; the hash of these vectors is published."""


def vectors(
    count: int, seed: int = 0, reference: bool = True, only: str | None = None
) -> Iterator[dict[str, Any]]:
    """``count`` vectors: id, class, label, scene, the oracle's answer. ``only``: of one class."""
    every = enumerate(scenes(None, seed))
    labelled = islice(((index, *row) for index, row in every if only in (None, row[0])), count)
    while batch := list(islice(labelled, BATCH)):
        answers = oracle([scene for *_, scene in batch], reference)
        for (index, kind, label, scene), found in zip(batch, answers, strict=True):
            finals = [found["results"][name]["double"] for name in FINAL_VELOCITIES]
            ends = f"ends with {found['ending']}" if found["ending"] else "answers"
            head = {
                "id": f"{seed}-{index:06d}",
                "class": kind,
                "label": label,
                "expect": _expected(kind, None not in finals),
                "flags": found["status"],
                "comment": f"{label}; the 1988 program {ends}",
                "scene": scene,
            }
            yield with_schema("vectors", head | found)


def expectation(kind: str, scene: Mapping[str, str]) -> str:
    """Return what is asked of a program by a scene of a class, the scene's results looked at."""
    finals = solve(doubles_of(scene), FINAL_VELOCITIES)
    return _expected(kind, all(np.isfinite(finals[name]) for name in FINAL_VELOCITIES))


def _expected(kind: str, has_solution: bool) -> str:
    if kind != FAILURE:
        return ANSWER
    return EITHER if has_solution else REFUSE


def published() -> str:
    """The packaged vectors, an object a line: the first `PUBLISHED` of seed `PUBLISHED_SEED`."""
    import gzip

    return gzip.decompress(packaged_bytes("impact88.golden", "vectors.jsonl.gz")).decode("utf-8")


def scenes(count: int | None, seed: int = 0) -> Iterator[tuple[str, str, Texts]]:
    """Class, label and scene of the first ``count`` vectors of a seed, or of all; none twice."""
    rng = Random(seed)
    seen = set()
    for index in islice(count_from(0), count):
        kind = CLASSES[index % 3]
        cases = {CASEWORK: {"random": _with()}, EDGE: EDGES, FAILURE: FAILURES}[kind]
        label = list(cases)[index // 3 % len(cases)]
        while True:
            scene = casework(rng)
            scene |= cases[label](rng, scene)
            texts = tuple(scene[name] for name in SCENE)
            if texts not in seen:
                break
        seen.add(texts)
        yield kind, label, dict(zip(SCENE, texts, strict=True))


def _between(rng: Random, low: float, high: float, places: int) -> str:
    """A decimal as people type it, with up to so many places."""
    places = rng.randint(0, places)
    return f"{rng.uniform(low, high):.{places}f}"


_CASEWORK: dict[str, _Range] = {
    **{"E": (0, 0.5, 3), "MU": (0, 0.9, 3), "EM": (-1, 0, 3), "DA": (0.5, 9, 2), "DB": (0.5, 9, 2)},
    **dict.fromkeys(("GA", "PA", "PB", "TA", "TB"), (-180, 180, 1)),
    **{"MA": (60, 400, 2), "MB": (60, 400, 2), "IA": (900, 9000, 1), "IB": (900, 9000, 1)},
    **dict.fromkeys(("UX", "UY", "VX", "VY"), (-90, 90, 3)),
    **{"WA": (-5, 5, 3), "WB": (-5, 5, 3)},
}
"""Slugs and feet, or the like."""


def casework(rng: Random) -> Texts:
    """A scene as casework has them; the vehicles approach."""
    while True:
        scene = {"M": "6"}
        for name in filter(_CASEWORK.get, SCENE):
            scene[name] = _between(rng, *_CASEWORK[name])
            if name in ("WA", "WB"):
                scene[name] = rng.choice(("0", scene[name]))
        if _closing(scene)[0] < 0:
            return scene


def _closing(scene: Texts) -> tuple[float, float]:
    """The relative velocity of the contact points before the impact, A minus B, along n and t."""
    g = doubles_of(scene)
    a, b = radians(g["TA"] + g["PA"]), radians(g["TB"] + g["PB"])
    dx = g["UX"] + g["DA"] * sin(a) * g["WA"] - g["VX"] + g["DB"] * sin(b) * g["WB"]
    dy = g["UY"] - g["DA"] * cos(a) * g["WA"] - g["VY"] - g["DB"] * cos(b) * g["WB"]
    c, s = cos(radians(g["GA"])), sin(radians(g["GA"]))
    return dx * c + dy * s, dy * c - dx * s


Case = Callable[[Random, Texts], Texts]
"""What a case changes in a casework scene."""


def _with(**values: str | _Range) -> Case:
    """Columns with a text, another column's, or one drawn from a range."""
    return lambda rng, scene: {
        name: scene.get(value, value) if isinstance(value, str) else _between(rng, *value)
        for name, value in values.items()
    }


def _drawn(names: str, text: Callable[[Random], str]) -> Case:
    """Columns with a text drawn for each."""
    return lambda rng, scene: {name: text(rng) for name in names.split()}


def _negative(name: str) -> Case:
    return lambda rng, scene: {name: f"-{scene[name]}"}


_STALE = {  # a matrix in which line 1080's RX stays at a row that has been used
    **{"MA": ".004", "IA": "4E-8", "DA": ".005", "PA": "90", "MB": "2E-11", "IB": "1E-20"},
    **{"DB": "0", "PB": "0", "GA": "-30", "TA": "0", "TB": "0", "E": ".5", "MU": ".5", "EM": "-1"},
    **{"WA": "0", "WB": "0", "M": "6"},
}
_SINGULAR = {  # the MU that makes the determinant nearly 0
    **{"E": "0.005", "MU": "3.19214397", "EM": "-0.715", "DA": "7.59", "DB": "3.44"},
    **{"GA": "-30.0", "PA": "-19.8", "PB": "-38.7", "TA": "0.0", "TB": "60.0"},
    **{"MA": "143.5", "MB": "95.8", "IA": "3728", "IB": "1961", "M": "6"},
}


def _sliding(values: Texts, *spins: str) -> Case:
    """A scene with any velocities that slide so that MU keeps the sign typed."""

    def case(rng: Random, scene: Texts) -> Texts:
        while True:
            velocities = {name: _between(rng, -40, 40, 3) for name in ("UX", "UY", "VX", "VY")}
            velocities |= {name: _between(rng, -5, 5, 3) for name in spins}
            if _closing({**values, **velocities})[1] < 0:
                return {**values, **velocities}

    return case


EDGES: dict[str, Case] = {
    "pivot": _with(MU="-10"),
    "point mass": _with(M="4", DA="0", DB="0", WA="0", WB="0"),
    "point mass, pivot": _with(M="4", DA="0", DB="0", WA="0", WB="0", MU="-10"),
    "no spin": _with(WA="0", WB="0"),
    "frictionless": _with(MU="0"),
    "plastic": _with(E="0"),
    "elastic": _with(E="1"),
    "no moment": _with(EM="1"),
    "equal final spins": _with(EM="0"),
    "contact at both centers": _with(DA="0", DB="0"),
    "right angles": _drawn("GA PA PB TA TB", lambda rng: str(90 * rng.randint(-4, 4))),
    "angles past a full turn": lambda rng, scene: {
        name: str(round(float(scene[name]) + 360 * rng.choice((-2, 2)), 1)) for name in ("GA", "TB")
    },
    "no relative sliding": _with(GA="0", DA="0", DB="0", VY="UY", WA="0", WB="0"),
    "heavy against light": lambda rng, scene: {
        "MB": f"1E{rng.randint(4, 9)}",
        "IB": f"1E{rng.randint(5, 11)}",
    },
    "SI units": _with(MA=(800, 3000, 1), MB=(800, 3000, 1)),
    "separating": _with(UX="VX", UY="VY", VX="UX", VY="UY"),
    "friction beyond critical": _with(MU=(1.5, 3, 2)),
    "ten digits typed": _drawn("IA IB", lambda rng: f"{rng.uniform(1000, 99999):.5f}"),
    "masses below 1": _drawn("MA MB IA IB", lambda rng: f"{rng.uniform(0.05, 0.95):.4f}"),
    "point mass without inertias": _with(M="4", DA="0", DB="0", WA="0", WB="0", IA="0", IB="0"),
}
"""Label -> what makes a casework scene that edge."""

FAILURES: dict[str, Case] = {
    "all at rest": _with(UX="0", UY="0", WA="0", VX="0", VY="0", WB="0"),
    "IA is zero": _with(IA="0"),
    "IB is zero": _with(IB="0"),
    "MA is zero": _with(MA="0"),
    "overflow": _drawn("UX", lambda rng: f"1E{rng.randint(20, 38)}"),
    "tiny units": lambda rng, scene: {
        name: _between(rng, 1, 9, 1) + power
        for name, power in (("MA", "E-12"), ("MB", "E-12"), ("IA", "E-11"), ("IB", "E-11"))
    },
    "MU flipped to the pivot's": _with(MU="10"),
    "MU below the pivot's": lambda rng, scene: {"MU": str(-rng.randint(11, 20))},
    "point mass with arms left": _with(M="4"),
    "stale pivot row": _sliding(_STALE),
    "singular friction": _sliding(_SINGULAR, "WA", "WB"),
    "same velocity": _with(VX="UX", VY="UY", WA="0", WB="0"),
    "MB is zero": _with(MB="0"),
    **{f"{name} negative": _negative(name) for name in ("MA", "MB", "IA", "IB")},
}
"""Label -> what makes a casework scene that failure, or invites it."""
