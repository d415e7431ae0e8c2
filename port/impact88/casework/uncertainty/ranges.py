"""Scene files with ranges: the inputs of a problem whose values are known within limits.

The file is a scene's (`program.scene`) whose values may be texts such as "0.7 .. 0.9"
(`collision.uncertain`), with ``correlations = "UX,VX 0.5; MA,IA 0.9"`` and, for a reconstruction,
the six final velocities and MUP, the signed P_t/P_n. Without those they are taken from the forward
solution of the nominal values: how well would the initial velocities have been found again?"""

from collections.abc import Collection, Mapping
from dataclasses import dataclass

from ...collision import uncertain
from ...collision.case import OWN_NAMES, Case, is_range
from ...collision.doubles import digits, double
from ...collision.geometry import MOVES, coordinate_names, resolve_contact_point
from ...collision.uncertain import Uncertain
from ...collision.units import reorient_text
from ...errors import UserError
from ...mechanics.closedform.columns import OPTIONAL_OF_POINTS
from ...mechanics.state import KNOWABLE
from ...names import FINAL_VELOCITIES, SCENE, VELOCITIES, check_names

Pair = tuple[str, str]
AFTER = (*FINAL_VELOCITIES, "MUP")  # inputs of a reconstruction alone


@dataclass(frozen=True)
class Inputs:
    """The inputs of `impact88.bounds`.

    ``values`` by name, ``correlations`` by pair of names; ``derived``: names whose values are the
    forward solution's; ``case``: what they were read from."""

    values: dict[str, Uncertain]
    correlations: dict[Pair, float]
    case: Case
    derived: tuple[str, ...] = ()


def input_names(problem: str) -> tuple[str, ...]:
    """Return the values a problem needs. CX and CY, which move the contact point, may be given in
    addition."""
    before = (*VELOCITIES, "MU")
    common = (name for name in SCENE if name not in before)
    return (*common, *(before if problem == "forward" else AFTER))


def complete(
    given: Collection[str], problem: str, source: str | None = None, point: bool = False
) -> tuple[str, ...]:
    """Return the names a problem needs, those of the contact point as they are ``given``, of point
    masses (``point``) without what is not given of `OPTIONAL_OF_POINTS`. Raise UserError where one
    is missing."""
    names = coordinate_names(input_names(problem), given)
    optional = OPTIONAL_OF_POINTS if point and problem == "forward" else ()
    names = tuple(name for name in names if name in given or name not in optional)
    if missing := [name for name in names if name not in given]:
        hint = " (MUP: the friction coefficient as signed P_t/P_n)" if "MUP" in missing else ""
        raise UserError(
            f"{' '.join(missing)} missing; the {problem} problem needs it{hint}", source
        )
    return names


def read_inputs(
    texts: Mapping[str, str] | Case,
    changes: Mapping[str, str] | None = None,
    problem: str = "forward",
) -> Inputs:
    """Return the inputs of ``problem`` (forward or reconstruction).

    Parameters
    ----------
    texts
        A case, or texts as a file has them.
    changes
        What is changed of it: ``+- D`` is around the value there.

    Raises
    ------
    UserError
        For unknown or missing names and for texts that are no value or range.
    """
    case = texts if isinstance(texts, Case) else Case(texts, "scene")
    source, changes = case.source, changes or {}
    forward = problem == "forward"
    scene = coordinate_names(SCENE, case.values)
    names_used = (*scene, *AFTER, *MOVES)
    for name in case.values:
        if name in KNOWABLE and name not in names_used:
            raise UserError(f"{name!r} is not a name used here; reconstruct takes it", source)
    check_names(case.values, names_used, "name used here", source)
    wanted = coordinate_names(input_names(problem), {**case.values, **changes})
    # what only the forward solution is made of has one value
    single = [name for name, text in changes.items() if not forward and not is_range(text)]
    allowed = (*wanted, *MOVES, *OWN_NAMES, *(name for name in scene if name in single))
    check_names(changes, allowed, f"value of the {problem} problem", "--range")
    early = {name: text for name, text in changes.items() if name not in AFTER}
    case = case.replaced(early, "--range") if early else case
    derived: tuple[str, ...] = ()
    if not forward and not set(AFTER) & set(case.values) and not set(AFTER) <= set(changes):
        solution = _forward_solution(case)
        derived = tuple(name for name in AFTER if name not in changes)
        case = case.replaced(case.display_texts(solution))
    late = {name: text for name, text in changes.items() if name in AFTER}
    case = case.replaced(late, "--range") if late else case
    values = _read(case, (*scene, *MOVES) if forward else tuple(case.values))
    point = values["M"].nominal == 4
    wanted = (
        *complete(values, problem, source, point),
        *(name for name in MOVES if name in values),
    )
    correlations = read_correlations(case.correlations, source)
    return Inputs({name: values[name] for name in wanted}, correlations, case, derived)


def _read(case: Case, names: Collection[str]) -> dict[str, Uncertain]:
    return {
        name: uncertain.read(text, _where(case, name))
        for name, text in case.values.items()
        if name in names
    }


def _where(case: Case, name: str) -> str:
    """Return the place of a value for messages: ``FILE, NAME``, ``--range NAME``."""
    place = case.place(name)
    return f"{place} {name}" if place.startswith("--") else f"{place}, {name}"


def _forward_solution(case: Case) -> dict[str, str]:
    """Return the final velocities and MUP of the forward solution of the nominal values, as texts
    in base units; MUP has the limits of MU."""
    values = _read(case, tuple(case.values))
    missing = [name for name in coordinate_names(SCENE, values) if name not in values]
    if missing:
        raise UserError(
            f"neither final velocities ({' '.join(AFTER)}) nor the whole scene to have them from "
            f"({' '.join(missing)} missing)",
            case.source,
        )
    from ...mechanics.closedform.general import share_typed
    from ...mechanics.closedform.solve import solve

    scene = resolve_contact_point({name: item.nominal for name, item in values.items()})
    friction = case.values["MU"]
    if values["MU"].share:
        friction = digits(float(share_typed(scene, values["MU"].nominal)))
        scene["MU"] = double(friction)
    solved = solve(scene, AFTER)
    if float(solved["MUP"]) == -scene["MU"]:
        friction = reorient_text("", friction, -1, 0)
    result = {name: digits(float(solved[name])) for name in FINAL_VELOCITIES}
    return {**result, "MUP": friction}


def read_correlations(text: str, source: str) -> dict[Pair, float]:
    """Return correlations by pair of names from ``NAME,NAME R; NAME,NAME R``. Raise UserError."""
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
