"""The oracle: all that is computed of a scene, to check other programs with."""

import json
from collections.abc import Iterable, Iterator, Mapping
from decimal import Decimal
from typing import Any

import numpy as np

from .. import status
from ..decimals import to_double, to_text
from ..errors import UserError
from ..mechanics.solve import solve
from ..names import DEFAULT_M, SCENE
from ..program.replay import replay, unpack
from ..program.run import run
from ..program.scene import Scene
from . import agreement
from .spellings import COMPARED

SCHEMA = "impact88/oracle/3"
DIGITS = 30


def oracle(
    scenes: Mapping[str, Any] | Iterable[Mapping[str, Any]], reference: bool = True
) -> list[dict[str, Any]]:
    """Return all that is computed of each scene, for checking another program.

    Parameters
    ----------
    scenes : mapping, or iterable of mapping
        Scenes by the listing's names: decimal texts, or numbers with their shortest digits. M is 6
        (the default) or 4.
    reference : bool, default True
        Compute each result to 30 digits, too (extra ``oracle``).

    Returns
    -------
    list of dict
        For each scene ``scene``, ``printout`` and ``ending`` of the 1988 program, and ``results``:
        each as ``printed`` and ``stored`` (five bytes in hexadecimal), the exact ``decimal`` of
        those, in ``double`` precision, its ``bound`` (what rounding may change in a careful
        program) and the ``reference`` to 30 digits; None where there is none. ``condition`` is the
        condition number, ``status`` the names of the warnings.

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
    inputs: list[Any] = [scenes]
    if isinstance(scenes, Iterable) and not isinstance(scenes, Mapping):
        inputs = list(scenes)
    valid_scenes = [_scene(scene) for scene in inputs]
    if not valid_scenes:
        return []
    digits = _reference_digits(valid_scenes) if reference else [{}] * len(valid_scenes)
    texts = {name: [scene[name] for scene in valid_scenes] for name in SCENE}
    numbers = {name: np.array(list(map(to_double, c))) for name, c in texts.items()}
    doubles = solve(numbers, ["STATUS", "COND", *COMPARED])
    bounds = agreement.reference(numbers).bounds
    applesoft = _applesoft(texts)
    answers = []
    for row, scene in enumerate(valid_scenes):
        listing_run = run(scene)
        results = {}
        for name in COMPARED:
            printed, stored, decimal = applesoft[name][row] if name in applesoft else (None,) * 3
            double = float(doubles[name][row])
            results[name] = {
                "printed": printed,
                "stored": stored,
                "decimal": decimal,
                "double": _finite(double),
                "bound": _finite(float(bounds[name][row])),
                "reference": digits[row].get(name),
            }
        answers.append(
            {
                "schema": SCHEMA,
                "scene": dict(scene),
                "printout": listing_run.printout,
                "ending": "ZERO DETERMINANT" if listing_run.zero_determinant else listing_run.error,
                "results": results,
                "condition": _finite(float(doubles["COND"][row])),
                "status": status.names(int(doubles["STATUS"][row])),
            }
        )
    return answers


def answer_lines(lines: Iterable[str], reference: bool = True) -> Iterator[dict[str, Any]]:
    """Yield the answer to each line of JSON, ``{"id": ..., "scene": {...}}``.

    A line that cannot be used gives ``{"id", "error": {"line", "message"}}``.
    """
    for place, line in enumerate(lines, 1):
        if not line.strip():
            continue
        label = None
        try:
            entry = json.loads(line, parse_float=str, parse_int=str)
            label = json.loads(line).get("id") if isinstance(entry, dict) else None
            if not isinstance(entry, dict) or not isinstance(entry.get("scene"), dict):
                raise UserError('expected {"id": ..., "scene": {...}}')
            (answer,) = oracle([entry["scene"]], reference)
            yield {"id": label, **answer}
        except (ValueError, RecursionError) as error:
            message = {"line": place, "message": str(error)}
            yield {"schema": SCHEMA, "id": label, "error": message}


def _scene(values: Mapping[str, Any]) -> Scene:
    """Return a scene of texts or numbers."""
    if not isinstance(values, Mapping):
        raise UserError(f"{values!r:.60} is no scene; expected a mapping of names to numbers")
    try:
        texts = {n: x if isinstance(x, str) else to_text(float(x)) for n, x in values.items()}
    except (TypeError, ValueError):
        raise UserError("a value of the scene is no number; expected numbers or texts") from None
    scene = values if isinstance(values, Scene) else Scene({"M": DEFAULT_M, **texts})
    if to_double(scene["M"]) not in (4.0, 6.0):
        raise UserError(f"M is {scene['M']}; expected 6 or 4")
    return scene


def _finite(value: float) -> float | None:
    return value if np.isfinite(value) else None


def _reference_digits(scenes: Iterable[Scene]) -> list[dict[str, str]]:
    from ..mechanics.reference import thirty_digits

    return [thirty_digits(scene) for scene in scenes]


def _applesoft(texts: Mapping[str, list[str]]) -> dict[str, list[tuple[Any, Any, Any]]]:
    """Return each result of the 1988 program: printed, stored, and the stored bytes' value."""
    results = replay(texts)
    columns = {}
    for name in results.names:
        present = results.present(name).tolist()
        is_printed = name != "KF"
        is_stored = name != "LOSS"  # line 690 prints it without storing it
        printed = results.printed(name).tolist() if is_printed else [None] * len(present)
        reals = results.reals(name) if is_stored else np.zeros(len(present), np.uint64)
        values = unpack(reals).tolist()
        columns[name] = [
            (
                (text or None) if here else None,
                f"{real:010x}" if here and is_stored else None,
                f"{Decimal(value):f}" if here and is_stored else None,
            )
            for here, text, real, value in zip(
                present, printed, reals.tolist(), values, strict=True
            )
        ]
    return columns
