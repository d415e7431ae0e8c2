"""The oracle: everything this project knows about a scene, for checking other programs.

The 1988 program's printout; each result as Applesoft has it (text, the five bytes stored, their
exact decimal value), in double precision by the closed form, and to 30 digits; the scene's
condition; error bounds of final velocities and spins, relative to `errorbound.scales`; and
everything unphysical about it.
"""

import json
from collections.abc import Iterable, Iterator, Mapping
from decimal import Decimal
from typing import Any

from ... import status
from ...apple.applesoft.operators import Real
from ...casework.chapter import validation
from ...collision import doubles
from ...collision.case import check_mapping
from ...collision.casescene import Scene
from ...collision.mappings import shortest_text
from ...collision.units import base_of, system_of
from ...errors import UserError
from ...mechanics.accuracy import errorbound
from ...mechanics.closedform.solve import solve
from ...messages.arguments import explains_arguments
from ...messages.plaintable import plain
from ...messages.schemas import with_schema
from ...names import DEFAULT_M, RESULTS, SCENE
from ...program.replay import replay
from ...program.run import run

BATCH = 256  # scenes computed together, enough to make the overhead per scene small

_NOT_ANSWERED = ("COND", "STATUS")  # given under names of their own
_decode = json.JSONDecoder(parse_float=str, parse_int=str).decode


def answer(
    lines: Iterable[tuple[int, str]], reference: bool = True, units: str | None = None
) -> Iterator[dict[str, Any]]:
    """Yield the answers to numbered lines of JSON.

    A line that cannot be used gives ``{"id", "error": {"line", "message"}}``. ``reference``:
    compute 30 digits, too; ``units``: system of units of bare numbers where a scene names none.
    """
    questions: list[tuple[dict[str, Any], Scene | None]] = []
    for line, text in lines:
        head: dict[str, Any] = {"id": None}
        try:
            questions.append((head, _parse_question(text, head, units)))
        except (UserError, ValueError, RecursionError) as error:
            message = str(error) or type(error).__name__
            failure = {"id": head["id"], "error": {"line": line, "message": message}}
            questions.append((failure, None))
    answers = iter(oracle([scene for _, scene in questions if scene is not None], reference))
    for entry, scene in questions:
        if scene is not None:
            entry |= {"scene": {name: scene[name] for name in SCENE}, **next(answers)}
            if scene.units:
                entry["units"] = base_of(system_of(scene.units))
            if remarks := [*scene.remarks.values()]:
                entry["remarks"] = remarks
        yield with_schema("oracle", entry)


def published_tests(reference: bool = True) -> Iterator[dict[str, Any]]:
    """Yield the answer for each published crash test, with its ``source``, and with each number
    ``reported`` there and the one computed here."""
    checks: dict[str, list[dict[str, Any]]] = {}
    for check in validation.checks():
        fields = check._asdict()
        name = f"{fields.pop('source')} {fields.pop('test')}"
        checks.setdefault(name, []).append(fields)
    tests = validation.program_scenes()
    answers = oracle(
        [_scene_of({"M": float(DEFAULT_M), **scene}) for scene in tests.values()], reference
    )
    for (name, scene), entry in zip(tests.items(), answers, strict=True):
        texts = _scene_of({"M": float(DEFAULT_M), **scene})
        source = next(text for kind, text in validation.SOURCES.items() if name.startswith(kind))
        head = {"id": name, "source": source, "reported": checks[name]}
        yield with_schema("oracle", {**head, "scene": {n: texts[n] for n in SCENE}, **entry})


def _parse_question(text: str, head: dict[str, Any], units: str | None) -> Scene:
    """Return the scene of a line; put its ``id``, ``class`` and ``label`` into ``head``."""
    try:
        # ids keep their type; the scene's numbers keep their digits
        entry, digits = json.loads(text), _decode(text)
    except ValueError as error:
        raise ValueError(f"is not JSON: {error}") from None
    if not isinstance(entry, dict):
        raise ValueError('is not a JSON object; expected {"id": ..., "scene": {...}}')
    head |= {name: entry[name] for name in ("id", "class", "label") if name in entry}
    values = digits.get("scene")
    if not isinstance(values, dict):
        raise ValueError('has no "scene" object')
    for name, value in values.items():
        if not isinstance(value, str):
            raise ValueError(f"{name} is not a number; expected a number or its decimal text")
    return _check_m(Scene.from_mapping({"M": DEFAULT_M, **values}, "scene", units))


def _scene_of(values: Mapping[str, Any]) -> Scene:
    """Return the scene of texts, or of numbers by their shortest digits. Raises UserError."""
    if isinstance(values, Scene):
        return values
    check_mapping(values)
    return Scene({n: v if isinstance(v, str) else shortest_text(n, v) for n, v in values.items()})


def _check_m(scene: Scene) -> Scene:
    """Return the scene. Raises UserError where M is neither 4 nor 6."""
    if doubles.double(scene["M"]) not in (4, 6):
        raise UserError(f"M is {scene['M']}; expected 6 or 4")
    return scene


@explains_arguments
def oracle(
    scenes: Mapping[str, Any] | Iterable[Mapping[str, Any]], reference: bool = True
) -> list[dict[str, Any]]:
    """Return everything known about each scene, for checking another program.

    Parameters
    ----------
    scenes : mapping, or iterable of mapping
        Scenes as `Scene`, or as mappings of names to decimal texts or to numbers, which stand for
        their shortest digits; M must be 4 or 6.
    reference : bool, default True
        Compute each result to 30 digits, too (extra ``oracle``).

    Returns
    -------
    list of dict
        For each scene the printout, each result as printed, stored, in double precision and to 30
        digits, and its error bounds: the form of ``impact88 schema oracle``.

    Raises
    ------
    UserError
        For a scene that cannot be used, and where mpmath is needed and not installed.

    Examples
    --------
    >>> import impact88
    >>> (answer,) = impact88.oracle(impact88.sample(1))
    >>> answer["results"]["VAX"]["printed"], answer["results"]["VAX"]["stored"]
    ('-13.263', '84d433d66f')
    """
    if isinstance(scenes, Mapping) or not isinstance(scenes, Iterable):
        scenes = [scenes]
    scenes = [_check_m(_scene_of(scene)) for scene in scenes]
    if not scenes:
        return []
    if reference:
        from ...mechanics.accuracy.reference import thirty_digits

    texts = {name: [scene[name] for scene in scenes] for name in SCENE}
    numbers = {name: doubles.doubles(column) for name, column in texts.items()}
    solution = solve(numbers)
    solved = {name: column.tolist() for name, column in solution.items()}
    replay_result = replay(texts)
    applesoft = {
        name: (
            replay_result.present(name).tolist(),
            replay_result.printed(name).tolist() if name != "KF" else [None] * len(scenes),
            replay_result.reals("KI" if name == "LOSS" else name).tolist(),
        )
        for name in RESULTS
        if name in replay_result.names
    }
    double, listing = errorbound.oracle_bounds(scenes, numbers, solution)
    absent = ([False] * len(scenes),) * 3
    out = []
    for index, scene in enumerate(scenes):
        listing_run = run(scene)
        digits = thirty_digits(scene) if reference else {}
        results: dict[str, dict[str, Any]] = {}
        for name in [name for name in RESULTS if name not in _NOT_ANSWERED]:
            present, text, real = (column[index] for column in applesoft.get(name, absent))
            # line 690 prints LOSS without storing it
            stored = f"{real:010x}" if present and name != "LOSS" else None
            results[name] = {
                "printed": (present and text) or None,
                "stored": stored,
                "decimal": exact_decimal(stored) if stored else None,
                "double": solved[name][index],
                "reference": digits.get(name),
            }
        entry = {
            "printout": listing_run.printout,
            "ending": "ZERO DETERMINANT" if listing_run.zero_determinant else listing_run.error,
            "results": results,
            "condition": solved["COND"][index],
            "error_bound": {"double": double[index], "applesoft": listing[index]},
            "status": status.names(int(solved["STATUS"][index])),
        }
        out.append(plain(entry))
    return out


def exact_decimal(stored: str) -> str:
    """Return the value of five stored bytes (hexadecimal) as an exact decimal with all its digits;
    a double holds it exactly."""
    return f"{Decimal(float(Real.from_stored(stored))):f}"
