"""Generate test vectors for other implementations: labelled scenes with the oracle's answers.

Three classes alternate: ``casework`` (as in reports), ``edge`` (one limit or special case) and
``failure`` (the 1988 program stops, or fails silently). A seed and a number give the same vector on
any machine.
"""

import json
from collections.abc import Callable, Iterator
from itertools import count as count_from
from itertools import islice
from math import cos, radians, sin
from random import Random
from typing import Any

from ...collision.doubles import doubles_of
from ...files import packaged_bytes
from ...messages.schemas import with_schema
from ...names import FINAL_VELOCITIES, SCENE
from .oracle import BATCH, oracle

Texts = dict[str, str]
_Range = tuple[float, float, int]
"""Lowest and highest value, and the maximum number of decimals typed."""

CASEWORK = "casework"
EDGE = "edge"
FAILURE = "failure"
CLASSES = (CASEWORK, EDGE, FAILURE)

# what is expected of a program
ANSWER = "answer"
REFUSE = "refuse"
EITHER = "either"

# the frozen vectors, which are packaged and whose hash is published: under this id their answers
# never change, and other vectors get another; every label occurs in at least 16 of them
FROZEN_ID = "1988.1"
FROZEN_COUNT = 1000
FROZEN_SEED = 1988


REFERENCE_BATCH = 20
"""Vectors answered together where each takes a hundredth of a second: progress is seen."""


def vectors(
    count: int, seed: int = 0, reference: bool = True, only: str | None = None
) -> Iterator[dict[str, Any]]:
    """Yield ``count`` vectors: id, class, label, scene, the oracle's answer.

    ``reference``: compute results to 30 digits, too; ``only``: the class wanted.
    """
    numbered = enumerate(scenes(None, seed))
    labelled = islice(((index, *row) for index, row in numbered if only in (None, row[0])), count)
    size = REFERENCE_BATCH if reference else BATCH
    while batch := list(islice(labelled, size)):
        answers = oracle([scene for *_, scene in batch], reference)
        for (index, kind, label, scene), answer in zip(batch, answers, strict=True):
            finals = [answer["results"][name]["double"] for name in FINAL_VELOCITIES]
            ends = f"ends with {answer['ending']}" if answer["ending"] else "answers"
            head = {
                "id": f"{seed}-{index:06d}",
                "class": kind,
                "label": label,
                "expect": _expected_answer(kind, None not in finals),
                "flags": answer["status"],
                "comment": f"{label}; the 1988 program {ends}",
                "scene": scene,
            }
            yield with_schema("vectors", head | answer)


def _expected_answer(kind: str, has_solution: bool) -> str:
    """Return what is expected of a program: an answer, a refusal or either."""
    if kind != FAILURE:
        return ANSWER
    return EITHER if has_solution else REFUSE


def frozen(count: int = FROZEN_COUNT, only: str | None = None) -> list[dict[str, Any]]:
    """Return the first ``count`` vectors of the frozen set; ``only``: the class wanted."""
    import gzip

    text = gzip.decompress(packaged_bytes("impact88.golden", "vectors.jsonl.gz")).decode("utf-8")
    vectors = map(json.loads, text.splitlines())
    return list(islice((vector for vector in vectors if only in (None, vector["class"])), count))


def scenes(count: int | None, seed: int = 0) -> Iterator[tuple[str, str, Texts]]:
    """Yield class, label and scene of the first ``count`` vectors of a seed (None: without end);
    no scene twice."""
    rng = Random(seed)
    seen = set()
    for index in islice(count_from(0), count):
        kind = CLASSES[index % 3]
        cases = {CASEWORK: {"random": _replace()}, EDGE: EDGES, FAILURE: FAILURES}[kind]
        label = list(cases)[index // 3 % len(cases)]
        while True:
            scene = casework(rng)
            scene |= cases[label](rng, scene)
            texts = tuple(scene[name] for name in SCENE)
            if texts not in seen:
                break
        seen.add(texts)
        yield kind, label, dict(zip(SCENE, texts, strict=True))


def _draw_decimal(rng: Random, low: float, high: float, max_decimals: int) -> str:
    """Return a decimal as people type it, with at most ``max_decimals`` decimals."""
    decimals = rng.randint(0, max_decimals)
    return f"{rng.uniform(low, high):.{decimals}f}"


_CASEWORK: dict[str, _Range] = {
    "E": (0, 0.5, 3),
    "MU": (0, 0.9, 3),
    "EM": (-1, 0, 3),
    "DA": (0.5, 9, 2),
    "DB": (0.5, 9, 2),
    **dict.fromkeys(("GA", "PA", "PB", "TA", "TB"), (-180, 180, 1)),
    "MA": (60, 400, 2),
    "MB": (60, 400, 2),
    "IA": (900, 9000, 1),
    "IB": (900, 9000, 1),
    **dict.fromkeys(("UX", "UY", "VX", "VY"), (-90, 90, 3)),
    "WA": (-5, 5, 3),
    "WB": (-5, 5, 3),
}
"""Ranges in ft, s and slug."""


def casework(rng: Random) -> Texts:
    """Return a scene as in casework, in which the vehicles approach."""
    while True:
        scene = {"M": "6"}
        for name in filter(_CASEWORK.get, SCENE):
            scene[name] = _draw_decimal(rng, *_CASEWORK[name])
            if name in ("WA", "WB"):
                scene[name] = rng.choice(("0", scene[name]))
        if _relative_velocity(scene)[0] < 0:
            return scene


def _relative_velocity(scene: Texts) -> tuple[float, float]:
    """Return the relative velocity of the contact points before the impact, A minus B, along n and
    along t."""
    g = doubles_of(scene)
    a, b = radians(g["TA"] + g["PA"]), radians(g["TB"] + g["PB"])
    dx = g["UX"] + g["DA"] * sin(a) * g["WA"] - g["VX"] + g["DB"] * sin(b) * g["WB"]
    dy = g["UY"] - g["DA"] * cos(a) * g["WA"] - g["VY"] - g["DB"] * cos(b) * g["WB"]
    c, s = cos(radians(g["GA"])), sin(radians(g["GA"]))
    return dx * c + dy * s, dy * c - dx * s


Case = Callable[[Random, Texts], Texts]
"""Function of a random generator and a casework scene: the columns that the case changes."""


def _replace(**values: str | _Range) -> Case:
    """Return the case that sets columns to a text, to another column's, or to one drawn from a
    range."""
    return lambda rng, scene: {
        name: scene.get(value, value) if isinstance(value, str) else _draw_decimal(rng, *value)
        for name, value in values.items()
    }


def _draw_each(names: str, draw: Callable[[Random], str]) -> Case:
    """Return the case that draws a text for each of several columns."""
    return lambda rng, scene: {name: draw(rng) for name in names.split()}


def _negate(name: str) -> Case:
    return lambda rng, scene: {name: f"-{scene[name]}"}


_STALE = {  # in its matrix, line 1080's RX stays at a row that has been used
    "MA": ".004",
    "IA": "4E-8",
    "DA": ".005",
    "PA": "90",
    "MB": "2E-11",
    "IB": "1E-20",
    "DB": "0",
    "PB": "0",
    "GA": "-30",
    "TA": "0",
    "TB": "0",
    "E": ".5",
    "MU": ".5",
    "EM": "-1",
    "WA": "0",
    "WB": "0",
    "M": "6",
}
_SINGULAR = {  # with a MU that makes the determinant nearly 0
    "E": "0.005",
    "MU": "3.19214397",
    "EM": "-0.715",
    "DA": "7.59",
    "DB": "3.44",
    "GA": "-30.0",
    "PA": "-19.8",
    "PB": "-38.7",
    "TA": "0.0",
    "TB": "60.0",
    "MA": "143.5",
    "MB": "95.8",
    "IA": "3728",
    "IB": "1961",
    "M": "6",
}


def _draw_velocities(values: Texts, *spins: str) -> Case:
    """Return the case with these values and random velocities, with sliding that leaves MU the sign
    typed (line 400)."""

    def case(rng: Random, scene: Texts) -> Texts:
        while True:
            velocities = {name: _draw_decimal(rng, -40, 40, 3) for name in ("UX", "UY", "VX", "VY")}
            velocities |= {name: _draw_decimal(rng, -5, 5, 3) for name in spins}
            if _relative_velocity({**values, **velocities})[1] < 0:
                return {**values, **velocities}

    return case


EDGES: dict[str, Case] = {
    "pivot": _replace(MU="-10"),
    "point mass": _replace(M="4", DA="0", DB="0", WA="0", WB="0"),
    "point mass, pivot": _replace(M="4", DA="0", DB="0", WA="0", WB="0", MU="-10"),
    "no spin": _replace(WA="0", WB="0"),
    "frictionless": _replace(MU="0"),
    "plastic": _replace(E="0"),
    "elastic": _replace(E="1"),
    "no moment": _replace(EM="1"),
    "equal final spins": _replace(EM="0"),
    "contact at both centers": _replace(DA="0", DB="0"),
    "right angles": _draw_each("GA PA PB TA TB", lambda rng: str(90 * rng.randint(-4, 4))),
    "angles past a full turn": lambda rng, scene: {
        name: str(round(float(scene[name]) + 360 * rng.choice((-2, 2)), 1)) for name in ("GA", "TB")
    },
    "no relative sliding": _replace(GA="0", DA="0", DB="0", VY="UY", WA="0", WB="0"),
    "heavy against light": lambda rng, scene: {
        "MB": f"1E{rng.randint(4, 9)}",
        "IB": f"1E{rng.randint(5, 11)}",
    },
    "SI units": _replace(MA=(800, 3000, 1), MB=(800, 3000, 1)),
    "separating": _replace(UX="VX", UY="VY", VX="UX", VY="UY"),
    "friction beyond critical": _replace(MU=(1.5, 3, 2)),
    "ten digits typed": _draw_each("IA IB", lambda rng: f"{rng.uniform(1000, 99999):.5f}"),
    "masses below 1": _draw_each("MA MB IA IB", lambda rng: f"{rng.uniform(0.05, 0.95):.4f}"),
    "point mass without inertias": _replace(M="4", DA="0", DB="0", WA="0", WB="0", IA="0", IB="0"),
}
"""Label -> case that makes a casework scene that edge."""

FAILURES: dict[str, Case] = {
    "all at rest": _replace(UX="0", UY="0", WA="0", VX="0", VY="0", WB="0"),
    "IA is zero": _replace(IA="0"),
    "IB is zero": _replace(IB="0"),
    "MA is zero": _replace(MA="0"),
    "overflow": _draw_each("UX", lambda rng: f"1E{rng.randint(20, 38)}"),
    "tiny units": lambda rng, scene: {
        name: _draw_decimal(rng, 1, 9, 1) + power
        for name, power in (("MA", "E-12"), ("MB", "E-12"), ("IA", "E-11"), ("IB", "E-11"))
    },
    "MU flipped to the pivot's": _replace(MU="10"),
    "MU below the pivot's": lambda rng, scene: {"MU": str(-rng.randint(11, 20))},
    "point mass with arms left": _replace(M="4"),
    "stale pivot row": _draw_velocities(_STALE),
    "singular friction": _draw_velocities(_SINGULAR, "WA", "WB"),
    "same velocity": _replace(VX="UX", VY="UY", WA="0", WB="0"),
    "MB is zero": _replace(MB="0"),
    **{f"{name} negative": _negate(name) for name in ("MA", "MB", "IA", "IB")},
}
"""Label -> case that makes a casework scene that failure, or a likely one."""
