"""The oracle: everything this project knows about a scene, for checking other programs.

For each scene: what the 1988 program prints; each result as Applesoft has it (printed text, the
five bytes stored, their exact decimal value), in double precision by the closed form, and to 30
digits; its condition; how far rounding may take the final velocities and spins, in doubles and on
the Apple (a bound, relative to `errorbound.scales`); what is unphysical about it.
"""

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from decimal import Decimal
from typing import Any

from .. import doubles, status
from ..accuracy import errorbound
from ..errors import UserError
from ..names import DEFAULT_M, RESULTS, SCENE
from ..scene import Scene
from ..schemas import stamped
from ..units import base_of, system_of

BATCH = 256
"""Scenes computed together: enough that reading and replaying them costs little a scene."""
LONGEST_LINE = 1_000_000
"""Characters of the longest line that is read."""

_NO_NUMBERS = ("COND", "STATUS")
_decode = json.JSONDecoder(parse_float=str, parse_int=str).decode


class Request:
    """One line of input: its number, its ``id`` as given, and the scene or what is wrong; bare
    numbers are in ``units`` where the scene names none."""

    def __init__(self, line: int, text: str, units: str | None = None) -> None:
        self.line = line
        self.units = units
        self.id: Any = None
        self.extra: dict[str, Any] = {}
        self.scene: Scene | None = None
        self.problem = ""
        try:
            self._read(text)
        except (UserError, ValueError, RecursionError) as error:
            self.problem = str(error) or type(error).__name__

    def _read(self, text: str) -> None:
        if len(text) > LONGEST_LINE:
            raise ValueError(f"has more than {LONGEST_LINE:,} characters")
        try:
            # ids keep their type; the scene's numbers keep their digits
            whole = json.loads(text)
            digits = _decode(text)
        except ValueError as error:
            raise ValueError(f"is not JSON: {error}") from None
        if not isinstance(whole, dict):
            raise ValueError('is not a JSON object; expected {"id": ..., "scene": {...}}')
        self.id = whole.get("id")
        self.extra = {name: whole[name] for name in ("class", "label") if name in whole}
        values = digits.get("scene")
        if not isinstance(values, dict):
            raise ValueError('has no "scene" object')
        wrong = [name for name, value in values.items() if not isinstance(value, str)]
        if wrong:
            raise ValueError(f"{wrong[0]} is not a number; expected a number or its decimal text")
        scene = Scene.from_mapping({"M": DEFAULT_M, **values}, "scene", self.units)
        _check_model(scene)
        self.scene = scene


def _check_model(scene: Mapping[str, Any]) -> None:
    if doubles.double(scene["M"]) not in (4, 6):
        raise UserError(f"M is {scene['M']}; expected 6 or 4")


def answer(batch: Sequence[Request], reference: bool = True) -> Iterator[dict[str, Any]]:
    """The answers to some requests; one that cannot be used gives
    ``{"id", "error": {"line", "message"}}``. ``reference``: give 30 digits too."""
    scenes = [request.scene for request in batch if request.scene is not None]
    answers = iter(oracle(scenes, reference))
    for request in batch:
        if request.scene is None:
            error = {"line": request.line, "message": request.problem}
            yield stamped("oracle", {"id": request.id, "error": error})
        else:
            scene = {name: request.scene[name] for name in SCENE}
            whole = {"id": request.id, **request.extra, "scene": scene, **next(answers)}
            if request.scene.units:
                whole["units"] = base_of(system_of(request.scene.units))
            if remarks := [*request.scene.entries.remarks.values()]:
                whole["remarks"] = remarks
            yield stamped("oracle", whole)


def oracle(
    scenes: Mapping[str, Any] | Iterable[Mapping[str, Any]], reference: bool = True
) -> list[dict[str, Any]]:
    """What is known about each scene, or about the only one, see the module.

    A scene is a `Scene` or a mapping of names to decimal texts, or to numbers, which stand for
    their shortest digits; M must be 4 or 6. Raises UserError.

    >>> import impact88
    >>> (answer,) = impact88.oracle(impact88.sample(1))
    >>> answer["results"]["VAX"]["printed"], answer["results"]["VAX"]["stored"]
    ('-13.263', '84d433d66f')
    """
    from ..mappings import typed

    if isinstance(scenes, Mapping) or not isinstance(scenes, Iterable):
        scenes = [scenes]
    scenes = [typed(scene) for scene in scenes]
    for scene in scenes:
        _check_model(scene)
    if not scenes:
        return []

    from ..closedform.solve import solve
    from ..program.run import run
    from ..replay import replay

    if reference:
        from ..accuracy.digits import thirty_digits

    texts = {name: [scene[name] for scene in scenes] for name in SCENE}
    numbers = {name: doubles.doubles(column) for name, column in texts.items()}
    found = solve(numbers)
    solved = {name: column.tolist() for name, column in found.items()}
    replayed = replay(texts)
    applesoft = {
        name: (
            replayed.present(name).tolist(),
            replayed.printed(name).tolist() if name != "KF" else [None] * len(scenes),
            replayed.reals(name).tolist(),
        )
        for name in RESULTS
        if name in replayed.names
    }
    double, listing = errorbound.oracle_bounds(scenes, numbers, found)
    nothing = ([False] * len(scenes),) * 3
    out = []
    for index, scene in enumerate(scenes):
        ported = run(scene)
        digits = thirty_digits(scene) if reference else {}
        results: dict[str, dict[str, Any]] = {}
        for name in RESULTS:
            if name in _NO_NUMBERS:
                continue
            present, text, real = (column[index] for column in applesoft.get(name, nothing))
            # line 690 prints LOSS without storing it
            stored = f"{real:010x}" if present and name != "LOSS" else None
            results[name] = {
                "printed": (present and text) or None,
                "stored": stored,
                "decimal": exact_decimal(stored) if stored else None,
                "double": _json_number(solved[name][index]),
                "reference": digits.get(name),
            }
        out.append(
            {
                "printout": ported.printout,
                "ending": "ZERO DETERMINANT" if ported.zero_determinant else ported.error,
                "results": results,
                "condition": _json_number(solved["COND"][index]),
                "error_bound": {
                    "double": _json_number(double[index]),
                    "applesoft": _json_number(listing[index]),
                },
                "status": status.names(int(solved["STATUS"][index])),
            }
        )
    return out


def exact_decimal(stored: str) -> str:
    """The value of five stored bytes, which a double holds, as an exact decimal, all its digits."""
    from ..applesoft.operators import Real

    return f"{Decimal(float(Real.from_stored(stored))):f}"


def _json_number(value: float) -> float | None:
    """JSON has no NaN and no infinity."""
    return value if value == value and abs(value) != float("inf") else None
