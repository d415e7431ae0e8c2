"""Equation 19 (Section VI), an empirical estimate from masses, initial speeds and energy loss,
fitted to eleven staged collisions; no impact is solved. By default it has the factor 2/3 with which
all of Table 2 was computed and which the printed equation lacks; --as-printed leaves it out.

Given are MA MB, the speeds SA SB (or UX UY VX VY) and the loss: LOSS in percent, DT as the fraction
that the chapter writes, EL as energy (of crush); or --like for the range of losses of one category
of Table 2. With DVA or DVB in place of the loss, the loss they tell. With the velocities after,
VAX VAY VBX VBY, the speeds before of an A that came along x and a B along y (Section VII). A scene
file (impact88 scene) gives masses and velocities; its other values are not used. Units: any
consistent set.

examples:
  impact88 chapter delta-v crash.toml --like 90-side
  impact88 chapter delta-v crash.toml --set LOSS=40 --as-printed --json

exit status: 0 done; 2 bad input
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterable
from math import hypot, isfinite, nan
from typing import Any

from ..errors import BEYOND_DOUBLES, UserError
from ..names import FINAL_VELOCITIES, SCENE
from ..schemas import stamped
from ..units import System, system_of, written
from .options import add_json_argument, add_known_arguments, add_output_argument, known_values

KNOWABLE = (*SCENE, "SA", "SB", "LOSS", "DT", "EL", "DVA", "DVB", *FINAL_VELOCITIES[:4])
CATEGORIES = {
    "60-side": "60° FRONT TO SIDE",
    "90-side": "90° FRONT TO SIDE",
    "front": "10° FRONT TO FRONT",
    "rear": "10° FRONT TO REAR",
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of `impact88 delta-v`."""
    add_known_arguments(parser)
    parser.add_argument(
        "--like",
        choices=tuple(CATEGORIES),
        help="take the range of energy losses of this category of Table 2",
    )
    parser.add_argument(
        "--as-printed", action="store_true", help="Equation 19 as printed, without the factor 2/3"
    )
    add_json_argument(parser)
    add_output_argument(parser)


def main(args: argparse.Namespace) -> int:
    """Print the estimate, or its range."""
    from ..chapter.deltav import AS_PRINTED, AS_USED, delta_v, described
    from ..plaintable import plain

    known, named = known_values(args.file, args.set, KNOWABLE, args.units)
    units = system_of(named)
    for name in ("MA", "MB"):
        if not known.get(name, 0) > 0:
            raise UserError(f"{name} is missing or not positive; expected a mass", args.file)
    factor = AS_PRINTED if args.as_printed else AS_USED
    if set(FINAL_VELOCITIES[:4]) <= set(known) and not {"UX", "VY"} <= set(known):
        return _speeds(known, args, factor, units)
    speed_a = _speed(known, "SA", "UX", "UY", args.file)
    speed_b = _speed(known, "SB", "VX", "VY", args.file)
    given = {"MA": known["MA"], "MB": known["MB"], "SA": speed_a, "SB": speed_b}
    if "DVA" in known or "DVB" in known:
        return _loss_found(known, given, args, factor, units)
    losses, source = _losses({**known, **given}, args)
    estimates = []
    for loss in losses:
        estimate = delta_v({**given, "LOSS": loss}, factor)
        estimates.append({"LOSS": loss, **{name: float(v) for name, v in estimate.items()}})
    for row in estimates:
        _check_finite(row.values(), args.file)
    if args.json:
        whole = {
            "equation": described(factor),
            "factor": factor,
            "given": written(given, units),
            "loss_from": source,
            "estimates": [written(row, units) for row in estimates],
            "units": _labels((*given, "DVA", "DVB", "LOSS"), units),
        }
        print(json.dumps(stamped("delta-v", plain(whole)), allow_nan=False))
        return 0
    _show(given, estimates, source, described(factor), units)
    return 0


def _speeds(known: dict[str, float], args: argparse.Namespace, factor: float, units: System) -> int:
    """Speeds before from final velocities and the loss, as in Section VII."""
    from ..chapter.deltav import described, speeds_before
    from ..names import quantity
    from ..plaintable import number, plain, table

    losses, source = _losses(known, args)
    taken = "SA and SB as given" if {"SA", "SB"} <= set(known) else "those of Equations 13 and 14"
    found: list[dict[str, Any]] = []
    for loss in losses:
        for repeat, speeds in ((False, taken), (True, "those found, until they stay")):
            try:
                row = speeds_before(known, loss, factor, repeat)
            except UserError as error:
                if not repeat:
                    raise UserError(str(error), args.file) from None
                row = dict.fromkeys(("UX", "VY", "DVA", "DVB"), nan)
            found.append({"LOSS": loss, **written(row, units), "speeds": speeds})
    if args.json:
        labels = _labels(("LOSS", "UX", "VY", "DVA", "DVB"), units)
        whole = {
            "equation": described(factor),
            "loss_from": source,
            "estimates": found,
            "units": labels,
        }
        print(json.dumps(stamped("delta-v", plain(whole)), allow_nan=False))
        return 0
    names = ("LOSS", "UX", "VY", "DVA", "DVB")
    heading = [f"{name} [{units.label(quantity(name).unit)}]" for name in names[1:]]
    rows = [[number(row[n]) or "none" for n in names] + [row["speeds"]] for row in found]
    lines = table(rows, ["LOSS [%]", *heading, "speeds in Equation 19"], left=(5,))
    print("\n".join(lines))
    print(f"\nA came along x, B along y (UY = VX = 0). loss: {source}. Equations 20 and 21.")
    _caution(described(factor))
    return 0


def _loss_found(
    known: dict[str, float],
    given: dict[str, float],
    args: argparse.Namespace,
    factor: float,
    units: System,
) -> int:
    """The loss that velocity changes give."""
    from ..chapter.deltav import described, loss_of
    from ..plaintable import number, plain, table

    if args.like or {"LOSS", "DT", "EL"} & set(known):
        raise UserError("both a loss and a velocity change are given; expected one")
    found = {
        name: float(loss_of({**given, name: known[name]}, factor))
        for name in ("DVA", "DVB")
        if name in known
    }
    _check_finite(found.values(), args.file)
    if args.json:
        whole = {
            "equation": described(factor),
            "given": written(given, units),
            "LOSS_from": found,
            "units": _labels(given, units),
        }
        print(json.dumps(stamped("delta-v", plain(whole)), allow_nan=False))
        return 0
    rows = [
        [name, number(known[name] * units.factor(name)), number(loss)]
        for name, loss in found.items()
    ]
    heading = ["from", f"velocity change [{units.label('length/time')}]", "loss [percent]"]
    print("\n".join(table(rows, heading, left=(0,))))
    print()
    _caution(described(factor))
    return 0


def _check_finite(numbers: Iterable[float], source: str | None) -> None:
    if not all(map(isfinite, numbers)):
        raise UserError(BEYOND_DOUBLES, source)


def _caution(equation: str) -> None:
    from ..chapter.deltav import ERROR

    print(equation)
    print(f"An estimate: {ERROR};\nuntested elsewhere (Section VI).")


def _speed(known: dict[str, float], speed: str, x: str, y: str, source: str | None) -> float:
    if speed in known:
        if known[speed] < 0:
            raise UserError(f"{speed} is negative; expected a speed", source)
        return known[speed]
    if x in known and y in known:
        return hypot(known[x], known[y])
    raise UserError(f"{speed} is missing; expected it, or {x} and {y}", source)


def _losses(known: dict[str, float], args: argparse.Namespace) -> tuple[list[float], str]:
    """The losses to take, in percent, and where they come from."""
    if args.like:
        from ..chapter.staged import collisions

        if "LOSS" in known or "DT" in known:
            raise UserError("the loss and --like are both given; expected one")
        category = CATEGORIES[args.like]
        alike = [c for c in collisions() if c.category == category]
        losses = sorted(c.table2["loss"] for c in alike)
        numbers = ", ".join(str(c.number) for c in alike)
        return [losses[0], losses[-1]], f"Table 2, {category} (collisions {numbers})"
    if "EL" in known:
        if "LOSS" in known or "DT" in known:
            raise UserError("EL and another loss are both given; expected one")
        from ..chapter.deltav import loss_of_energy

        if not {"SA", "SB"} <= set(known):
            raise UserError("EL needs the speeds before; expected SA and SB, or LOSS or DT")
        loss = float(loss_of_energy(known))
        if not 0 <= loss <= 100:
            raise UserError(f"EL is {loss:.4g} percent of the initial kinetic energy")
        return [loss], "the energy EL"
    if "DT" in known:
        if "LOSS" in known:
            raise UserError("LOSS and DT are both given; expected one")
        if not 0 <= known["DT"] <= 1:
            raise UserError("DT is outside 0 ... 1; expected a fraction of the kinetic energy")
        return [100 * known["DT"]], "given"
    if "LOSS" not in known:
        raise UserError("LOSS is missing (percent of kinetic energy); expected it, DT or --like")
    if not 0 <= known["LOSS"] <= 100:
        raise UserError("LOSS is outside 0 ... 100; expected percent of the initial kinetic energy")
    if 0 < known["LOSS"] < 1:
        raise UserError(
            f"LOSS = {known['LOSS']:g} would be less than one percent; the chapter writes the "
            f"fraction, DT = {known['LOSS']:g} (and DT = {known['LOSS'] / 100:g} is what this says)"
        )
    return [known["LOSS"]], "given"


def _labels(names: Iterable[str], units: System) -> dict[str, str]:
    from ..names import quantity

    return {name: units.label(quantity(name).unit) for name in names}


def _show(
    given: dict[str, float],
    estimates: list[dict[str, float]],
    source: str,
    equation: str,
    units: System,
) -> None:
    from ..names import quantity
    from ..plaintable import number, table

    rows = [
        [n, number(v * units.factor(n)), units.label(quantity(n).unit), quantity(n).meaning]
        for n, v in given.items()
    ]
    print("\n".join(table(rows, left=(0, 2, 3))))
    names = ("LOSS", "DVA", "DVB")
    lines = [[number(e[n] * units.factor(n)) for n in names] for e in estimates]
    label = units.label("length/time")
    heading = ["loss [percent]", f"DVA [{label}]", f"DVB [{label}]"]
    print("\n".join(["", *table(lines, heading, left=())]))
    print(f"\nloss: {source}")
    _caution(equation)
