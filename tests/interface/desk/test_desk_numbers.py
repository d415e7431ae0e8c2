"""All numbers and units that the desk shows, in a browser, against the commands' own.

By default a scene, or two with IMPACT88_LONG=1; with IMPACT88_SWEEP=1 twenty scenes in four systems
of units.
"""

from __future__ import annotations

import csv
import io
import json
import math
import os
from collections.abc import Iterator
from itertools import product
from pathlib import Path
from typing import Any

import desk_browser
import pytest
from desk_browser import until
from unitscenes import texts

from impact88.collision.casescene import sample
from impact88.conformance.comparison.vectors import scenes
from impact88.interface.commands.cli import main
from impact88.mechanics.closedform.solve import solve
from impact88.names import FINAL_STATE, VELOCITIES

SWEEP = bool(os.environ.get("IMPACT88_SWEEP"))
pytestmark = pytest.mark.browser
Numbers = dict[str, tuple[float, str]]
REASON = "document.getElementById('reconstruction-waiting').textContent"
"""Why there is no solution."""


def some_scenes() -> list[dict[str, str]]:
    """Ordinary collisions in m, kg, s."""
    found = [dict(sample(number)) for number in (1, 3)]
    if SWEEP:
        found += [dict(values) for _, _, values in scenes(54, 28)][::3]
    return found


SCENES = some_scenes()
CASES = list(product(range(len(SCENES)), ("us", "metric", "si", "chapter"))) if SWEEP else []
DEFAULT = [(0, "us"), (1, "metric")] if os.environ.get("IMPACT88_LONG") else [(1, "metric")]


@pytest.fixture(scope="module")
def address() -> Iterator[str]:
    pytest.importorskip("flask", reason="the desk's extra is not installed")
    with desk_browser.desk() as served:
        yield served


@pytest.fixture(scope="module")
def page(address: str) -> Iterator[Any]:
    if missing := desk_browser.missing():
        pytest.skip(missing)
    with desk_browser.browser() as started:
        started.open(address)
        yield started


def fill(page: Any, view: str, values: dict[str, str], system: str) -> None:
    """Put values into a form, all at once."""
    told = json.dumps({f"{view}-{name}": text for name, text in values.items()})
    page.value(
        f"(() => {{ location.hash = '#{view}';"
        f" for (const field of document.querySelectorAll('#{view}-form input[name]'))"
        f" if (field.name !== 'M') field.value = '';"
        f" document.getElementById('{view}-units').value = '{system}';"
        f" for (const [id, text] of Object.entries({told})) {{"
        " const field = document.getElementById(id); field.value = text;"
        " field.dispatchEvent(new Event('input', { bubbles: true })); }"
        f" document.getElementById('{view}-units').dispatchEvent(new Event('change')); }})()"
    )


def shown(page: Any, selector: str) -> Numbers:
    """By name, what the page shows whole, with its unit."""
    rows = page.value(
        f"[...document.querySelectorAll('{selector} [data-name]')]"
        ".map((it) => [it.dataset.name, it.dataset.value, it.dataset.unit, it.textContent])"
    )
    found = {}
    for name, value, unit, text in rows:
        if not value:
            continue
        plain = {"1": "", "%": "percent", "°": "deg", "degree": "deg"}.get(unit, unit)
        found[name] = (float(value), plain)
        # what is read is what stands there whole
        digits = text.split()[0]
        if float(digits):
            assert float(digits) == pytest.approx(float(value), rel=6e-3)
        else:
            assert abs(float(value)) < 1e-6
    return found


def agree(page: Any, selector: str, expected: Numbers, least: int) -> None:
    """Fails unless the page comes to show just these."""

    def same() -> bool:
        found = shown(page, selector)
        return len(found) >= least and all(
            name in expected
            and math.isclose(value, expected[name][0], rel_tol=1e-12, abs_tol=1e-9)
            and unit in (expected[name][1], "" if expected[name][1] == "1" else None)
            for name, (value, unit) in found.items()
        )

    try:
        until(same, f"the numbers in {selector}", 30)
    except AssertionError:
        found = shown(page, selector)
        wrong = {n: (one, expected.get(n)) for n, one in found.items() if one != expected.get(n)}
        raise AssertionError(f"{len(found)} shown, {wrong}") from None


def printed(capsys: Any, *words: str) -> Any:
    capsys.readouterr()
    assert main(list(words)) == 0
    return capsys.readouterr().out


def solution(text: str) -> Numbers:
    """The numbers of the first solution that `impact88 reconstruct --json` prints."""
    one = json.loads(text)["solutions"][0]
    units = one["units"]
    found = {n: (v, units.get(n, "")) for n, v in one["values"].items() if v is not None}
    parts = {"sd": "first_order", "lower": "lower", "upper": "upper"}
    for name, spread in one.get("uncertainty", {}).items():
        rows = {head: spread[key] for head, key in parts.items()}
        rows |= {"5 %": spread["quantiles"]["0.05"], "95 %": spread["quantiles"]["0.95"]}
        found |= {f"{name} {head}": (v, units.get(name, "")) for head, v in rows.items()}
    for name, value in one.get("amplification", {}).items():
        found[f"{name} error amplified"] = (value, units.get(name, ""))
    return found


def table(text: str) -> Numbers:
    """The first row of the table that `impact88 solve` prints."""
    head, row = list(csv.reader(io.StringIO(text)))[:2]
    cells = [(*h.partition(" [")[::2], cell) for h, cell in zip(head, row, strict=True)]
    return {name: (float(cell), unit.rstrip("]")) for name, unit, cell in cells if cell}


@pytest.mark.parametrize("case", CASES or [None])
def test_what_the_page_shows_is_what_the_commands_print(
    page: Any, case: tuple[int, str] | None, tmp_path: Path, capsys: Any
) -> None:
    for number, system in [case] if case else DEFAULT:
        values = texts(system, SCENES[number])
        path = tmp_path / "scene.toml"

        def write(entries: dict[str, str], path: Path = path, system: str = system) -> str:
            lines = "".join(f'{name} = "{text}"\n' for name, text in entries.items())
            path.write_text(f'units = "{system}"\n{lines}')
            return str(path)

        fill(page, "collision", values, system)
        file = write(values)
        whole = solution(printed(capsys, "reconstruct", file, "--json"))
        results = table(printed(capsys, "solve", file))
        friction = {name: results[name] for name in ("MUP", "MUC") if name in results}
        agree(page, "#collision-first", {**friction, **whole, **friction}, 15)
        agree(page, "#collision-results", results, 10)

        if number < 2:  # a second and more each
            ranged = {**values, "E": "0.1 .. 0.3"}
            fill(page, "collision", ranged, system)
            found = json.loads(
                printed(capsys, "bounds", write(ranged), "--json", "--samples", "20000")
            )
            bounds = {
                f"{name} {part}": (value, one["unit"])
                for name, one in found["outputs"].items()
                for part, value in {**one, **one["quantiles"]}.items()
                if isinstance(value, float | int)
            }
            agree(page, "#collision-bounds-table", bounds, 25)

        answer = solve({name: float(text) for name, text in SCENES[number].items()})
        if not abs(float(SCENES[number]["E"])) or SCENES[number]["M"] == "4":
            continue
        known = {n: t for n, t in SCENES[number].items() if n not in (*VELOCITIES, "MU")}
        known |= {name: repr(float(answer[name])) for name in (*FINAL_STATE, "MUP")}
        known = texts(system, known)
        fill(page, "reconstruction", known, system)
        capsys.readouterr()
        if main(["reconstruct", write(known), "--json"]) == 2:  # what is known does not do
            until(lambda: len(page.value(REASON)) > 20, "the reason", 30)
            continue
        agree(page, "#reconstruction-answer .solution", solution(capsys.readouterr().out), 9)
