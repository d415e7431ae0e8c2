"""Equation 19 (Section VI), an empirical estimate from masses, initial speeds and energy loss,
fitted to eleven staged collisions; no impact is solved. By default it has the factor 2/3 with which
all of Table 2 was computed and which the printed equation lacks; --as-printed leaves it out.

Given are MA MB, the speeds SA SB (or UX UY VX VY) and the loss: LOSS in percent, DT as the fraction
that the chapter writes, EL as energy (of crush); or --like for the range of losses of one category
of Table 2. With DVA or DVB in place of the loss, the loss they imply. With the velocities after,
VAX VAY VBX VBY, the speeds before of an A that came along x and a B along y (Section VII). A scene
file (impact88 scene) gives masses and velocities; its other values are not used. Units: any
consistent set.

examples:
  impact88 chapter delta-v crash.toml --like 90-side
  impact88 chapter delta-v crash.toml --set LOSS=40 --as-printed --json

exit status: 0 done; 2 bad input
"""

from collections.abc import Iterable, Mapping
from math import hypot, isfinite, nan
from typing import Any

from ...casework.chapter import deltav
from ...collision.units import System, display_values
from ...errors import BEYOND_DOUBLES, UserError
from ...messages.plaintable import number, quantities, table
from ...names import FINAL_VELOCITIES, SCENE, VELOCITY, quantity
from . import options

AFTER = FINAL_VELOCITIES[:4]
GIVEN = deltav.GIVEN[:4]
KNOWABLE = (*SCENE, "SA", "SB", "LOSS", "DT", "EL", "DVA", "DVB", *AFTER)
CATEGORIES = {
    "60-side": "60° FRONT TO SIDE",
    "90-side": "90° FRONT TO SIDE",
    "front": "10° FRONT TO FRONT",
    "rear": "10° FRONT TO REAR",
}

ARGUMENTS = (
    *options.KNOWN,
    options.sample_option("masses and velocities of a published run"),
    options.choice(
        "--like", tuple(CATEGORIES), "take the range of energy losses of this category of Table 2"
    ),
    options.flag("--as-printed", "Equation 19 as printed, without the factor 2/3"),
    options.JSON,
    options.OUTPUT,
)


Answer = tuple[dict[str, Any], list[str]]
"""Return the record that ``--json`` prints, and the lines for people."""


def main(args: options.Args) -> None:
    values, units = options.known_values(args, KNOWABLE)
    factor = deltav.AS_PRINTED if args.as_printed else deltav.AS_USED
    try:
        answer, lines = _answer(values, args.like, factor, units)
    except UserError as error:
        raise UserError(str(error), args.scene) from None
    equation = deltav.describe(factor)
    caution = f"An estimate: {deltav.ERROR};\nuntested elsewhere (Section VI)."
    record = {"equation": equation, **answer}
    options.show(args, "delta-v", lambda: record, lambda: [*lines, equation, caution])


def _answer(known: dict[str, float], like: str | None, factor: float, units: System) -> Answer:
    for name in ("MA", "MB"):
        if not known.get(name, 0) > 0:
            raise UserError(f"{name} is missing or not positive; expected a mass")
    if set(AFTER) <= set(known) and not {"UX", "VY"} <= set(known):
        return _speeds_before(known, like, factor, units)
    known |= {"SA": _speed(known, "SA", "UX", "UY"), "SB": _speed(known, "SB", "VX", "VY")}
    if "DVA" in known or "DVB" in known:
        return _loss(known, like, factor, units)
    estimates = []
    losses, source = _losses(known, like)
    for loss in losses:
        change = deltav.delta_v({**{n: known[n] for n in GIVEN}, "LOSS": loss}, factor)
        estimate = {"LOSS": loss, **{name: float(value) for name, value in change.items()}}
        _check_finite(estimate.values())
        estimates.append(display_values(estimate, units))
    speeds = display_values({n: known[n] for n in GIVEN}, units)
    label = units.label(VELOCITY)
    rows = [[number(estimate[n]) for n in ("LOSS", "DVA", "DVB")] for estimate in estimates]
    heading = ["loss [percent]", f"DVA [{label}]", f"DVB [{label}]"]
    lines = [
        *quantities(speeds, units.label, {}),
        "",
        *table(rows, heading, left=()),
        "",
        f"loss: {source}",
    ]
    record = {"factor": factor, "given": speeds, "loss_from": source, "estimates": estimates}
    return {**record, "units": _labels((*GIVEN, "DVA", "DVB", "LOSS"), units)}, lines


def _speeds_before(
    known: dict[str, float], like: str | None, factor: float, units: System
) -> Answer:
    """Return the speeds before impact from final velocities and the loss, as in Section VII."""
    losses, source = _losses(known, like)
    taken = "SA and SB as given" if {"SA", "SB"} <= set(known) else "those of Equations 13 and 14"
    records: list[dict[str, Any]] = []
    for loss in losses:
        for repeat, speeds in ((False, taken), (True, "those found, until they stay")):
            try:
                row = deltav.speeds_before(known, loss, factor, repeat)
            except UserError:
                if not repeat:
                    raise
                row = dict.fromkeys(("UX", "VY", "DVA", "DVB"), nan)
            records.append({"LOSS": loss, **display_values(row, units), "speeds": speeds})
    labels = _labels(("LOSS", "UX", "VY", "DVA", "DVB"), units)
    heading = [f"{name} [{'%' if name == 'LOSS' else unit}]" for name, unit in labels.items()]
    rows = [[number(row[n]) or "none" for n in labels] + [row["speeds"]] for row in records]
    came = f"A came along x, B along y (UY = VX = 0). loss: {source}. Equations 20 and 21."
    lines = [*table(rows, [*heading, "speeds in Equation 19"], left=(5,)), "", came]
    return {"loss_from": source, "estimates": records, "units": labels}, lines


def _loss(known: dict[str, float], like: str | None, factor: float, units: System) -> Answer:
    if like or {"LOSS", "DT", "EL"} & set(known):
        raise UserError("both a loss and a velocity change are given; expected one")
    base_values = {name: known[name] for name in GIVEN}
    changes = {name: value for name, value in known.items() if name in ("DVA", "DVB")}
    losses = {n: deltav.loss_of({**base_values, n: x}, factor) for n, x in changes.items()}
    _check_finite(losses.values())
    shown_changes = display_values(changes, units)
    rows = [[name, number(shown_changes[name]), number(loss)] for name, loss in losses.items()]
    heading = ["from", f"velocity change [{units.label('length/time')}]", "loss [percent]"]
    record = {
        "given": display_values(base_values, units),
        "LOSS_from": losses,
        "units": _labels(base_values, units),
    }
    return record, [*table(rows, heading), ""]


def _check_finite(numbers: Iterable[float]) -> None:
    if not all(map(isfinite, numbers)):
        raise UserError(BEYOND_DOUBLES)


def _speed(known: Mapping[str, float], speed: str, x: str, y: str) -> float:
    if speed in known:
        if known[speed] < 0:
            raise UserError(f"{speed} is negative; expected a speed")
        return known[speed]
    if x in known and y in known:
        return hypot(known[x], known[y])
    raise UserError(f"{speed} is missing; expected it, or {x} and {y}")


def _losses(known: Mapping[str, float], like: str | None) -> tuple[list[float], str]:
    """Return the losses to take, in percent, and their source."""
    loss_names = [name for name in ("EL", "DT", "LOSS") if name in known]
    if len(loss_names) + bool(like) > 1:
        raise UserError(
            f"{' and '.join([*loss_names, *['--like'] * bool(like)])} are both given; expected one"
        )
    if like:
        from ...casework.chapter.staged import collisions

        category = CATEGORIES[like]
        alike = [c for c in collisions() if c.category == category]
        losses = sorted(c.table2["loss"] for c in alike)
        numbers = ", ".join(str(c.number) for c in alike)
        return [losses[0], losses[-1]], f"Table 2, {category} (collisions {numbers})"
    if not loss_names:
        raise UserError("LOSS is missing (percent of kinetic energy); expected it, DT or --like")
    if loss_names == ["EL"]:
        if not {"SA", "SB"} <= set(known):
            raise UserError("EL needs the speeds before; expected SA and SB, or LOSS or DT")
        loss = deltav.loss_of_energy(known)
        if not 0 <= loss <= 100:
            raise UserError(f"EL is {loss:.4g} percent of the initial kinetic energy")
        return [loss], "the energy EL"
    loss, limit, meaning = known.get("LOSS", 0.0), 100, "percent of the initial kinetic energy"
    if loss_names == ["DT"]:
        loss, limit, meaning = known["DT"], 1, "a fraction of the kinetic energy"
    if not 0 <= loss <= limit:
        raise UserError(f"{loss_names[0]} is outside 0 ... {limit}; expected {meaning}")
    if loss_names == ["DT"]:
        return [100 * loss], "given"
    if 0 < loss < 1:
        raise UserError(
            f"LOSS = {loss:g} would be less than one percent; the chapter writes the fraction, "
            f"DT = {loss:g} (for {loss:g} percent write DT = {loss / 100:g})"
        )
    return [loss], "given"


def _labels(names: Iterable[str], units: System) -> dict[str, str]:
    return {name: units.label(quantity(name).unit) for name in names}
