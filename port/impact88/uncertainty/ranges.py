"""Scene files with ranges: the inputs of a problem whose values are known within limits.

The file is a scene's (`impact88.scene`) whose values may be texts such as "0.7 .. 0.9"
(`uncertainty.uncertain`), with ``correlations = "UX,VX 0.5; MA,IA 0.9"`` and, for a reconstruction,
the six final velocities and MUP, the signed P_t/P_n. Without those it takes them from the forward
solution of the nominal values: how well would the initial velocities have been found again?
"""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace

from ..errors import UserError
from ..names import DEFAULT_M, FINAL_VELOCITIES, SCENE, VELOCITIES, check_names
from ..reconstruction.geometry import MOVES, moved, placed
from . import uncertain
from .uncertain import Uncertain

Pair = tuple[str, str]
AFTER = (*FINAL_VELOCITIES, "MUP")
"""What only a reconstruction starts from."""


@dataclass(frozen=True)
class Inputs:
    """What `impact88.bounds` takes: ``values`` by name, ``correlations`` by pair of names;
    ``derived``: names whose values are the forward solution's."""

    values: dict[str, Uncertain]
    correlations: dict[Pair, float]
    derived: tuple[str, ...] = ()


def input_names(problem: str) -> tuple[str, ...]:
    """The values a problem needs; CX and CY may move the contact point beside them."""
    before = (*VELOCITIES, "MU")
    common = (name for name in SCENE if name not in before)
    return (*common, *(before if problem == "forward" else AFTER))


def complete(given: Collection[str], problem: str, source: str | None = None) -> tuple[str, ...]:
    """The names a problem needs, the contact point's as they are ``given``. Raises UserError where
    one is missing."""
    names = placed(input_names(problem), given)
    if missing := [name for name in names if name not in given]:
        hint = " (MUP: the friction coefficient as signed P_t/P_n)" if "MUP" in missing else ""
        raise UserError(
            f"{' '.join(missing)} missing; the {problem} problem needs it{hint}", source
        )
    return names


def read_inputs(
    texts: Mapping[str, str],
    changes: Mapping[str, str],
    problem: str = "forward",
    source: str = "scene",
) -> Inputs:
    """The inputs of ``problem`` (forward or reconstruction) from a file's texts by name and the
    ``changes`` made to them; ``+- D`` in a change is around the file's value. Raises UserError for
    unknown or missing names and for texts that are no value or range."""
    entries = {"M": DEFAULT_M, **texts}
    entries.pop("title", None)
    correlations = read_correlations(entries.pop("correlations", ""), source)
    scene = placed(SCENE, entries)
    check_names(entries, (*scene, *AFTER, *MOVES), "name used here", source)
    wanted = placed(input_names(problem), entries)
    check_names(changes, (*wanted, *MOVES), f"value of the {problem} problem", "--range")
    values = {
        name: uncertain.read(text, f"{source}, {name}")
        for name, text in entries.items()
        if name in (*scene, *MOVES) or problem != "forward"
    }
    derived: tuple[str, ...] = ()
    if problem != "forward" and not set(AFTER) & set(values) and not set(AFTER) <= set(changes):
        values |= _forward_solution(values, source)
        derived = tuple(name for name in AFTER if name not in changes)
    for name, text in changes.items():
        center = values[name].nominal if name in values else 0.0 if name in MOVES else None
        values[name] = uncertain.read(text, f"--range {name}", center)
    wanted = (*complete(values, problem, source), *(name for name in MOVES if name in values))
    return Inputs({name: values[name] for name in wanted}, correlations, derived)


def _forward_solution(values: Mapping[str, Uncertain], source: str) -> dict[str, Uncertain]:
    """The final velocities and MUP of the forward solution of the nominal values."""
    missing = [name for name in placed(SCENE, values) if name not in values]
    if missing:
        raise UserError(
            f"neither final velocities ({' '.join(AFTER)}) nor the whole scene to have them from "
            f"({' '.join(missing)} missing)",
            source,
        )
    from ..closedform.solve import share_typed, solve

    scene = moved({name: item.nominal for name, item in values.items()})
    friction = values["MU"]
    if friction.share:
        friction = uncertain.fixed(float(share_typed(scene, friction.nominal)))
        scene = {**scene, "MU": friction.nominal}
    solved = solve(scene, AFTER)
    if float(solved["MUP"]) == -friction.nominal:
        friction = replace(
            friction, nominal=-friction.nominal, low=-friction.high, high=-friction.low
        )
    result = {name: uncertain.fixed(float(solved[name])) for name in FINAL_VELOCITIES}
    return {**result, "MUP": friction}


def read_correlations(text: str, source: str) -> dict[Pair, float]:
    """Pairs of names and their correlation from ``NAME,NAME R; NAME,NAME R``. Raises UserError."""
    result: dict[Pair, float] = {}
    for part in filter(None, map(str.strip, text.split(";"))):
        names, _, number = part.rpartition(" ")
        first, comma, second = (piece.strip().upper() for piece in names.partition(","))
        try:
            value = float(number)
        except ValueError:
            comma = ""
        if not comma or not first or not second:
            raise UserError(
                f"{part!r} is not a correlation; expected NAME,NAME R such as UX,VX 0.5", source
            )
        if result.setdefault((first, second), value) != value:
            raise UserError(f"the correlation of {first},{second} is given twice", source)
    return result
