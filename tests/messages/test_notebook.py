"""What a notebook shows of a result is what the command prints, and nothing in it is markup."""

from __future__ import annotations

import re
from html import unescape
from pathlib import Path
from typing import Any

import pytest

import impact88
from impact88.interface.commands.cli import main
from impact88.printouts.reporting.examination import examine

SCRIPT = "<script>alert('&')</script>"


def shown(value: Any) -> str:
    """The text that the HTML shows, whose only element is one <pre>."""
    inner = re.fullmatch(r'<pre style="font-family: monospace">([^<>]*)</pre>', value._repr_html_())
    assert inner
    return unescape(inner[1])


def printed(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    assert main(arguments) in (0, 1)
    return capsys.readouterr().out.removesuffix("\n")


def test_run_and_scene(capsys: pytest.CaptureFixture[str]) -> None:
    scene = impact88.sample(2)
    assert shown(impact88.run(scene)).removesuffix("\n") == printed(capsys, "run", "--sample", "2")
    assert shown(scene).removesuffix("\n") == printed(capsys, "scene", "--sample", "2")
    assert f'title = "{SCRIPT}"' in shown(impact88.Scene(scene, title=SCRIPT))


def test_verification(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    page = impact88.run(impact88.sample(1)).page.replace("VAX= -13.263", "VAX= -18.263")
    path = tmp_path / SCRIPT.replace("/", "|")
    path.write_text(f"{page} {SCRIPT} 7{SCRIPT}")
    (result,) = examine(str(path)).results
    text = shown(result)
    assert text.rstrip("\n") == printed(capsys, "verify", str(path)).rstrip("\n")
    assert path.name in text
    assert "DIFFERS" in text


def test_bounds(capsys: pytest.CaptureFixture[str]) -> None:
    values: dict[str, Any] = {**impact88.sample(1).numbers(), "units": "chapter"}
    values["MU"] = impact88.Uncertain("uniform", 0.8, 0.7, 0.9)
    answer = impact88.bounds(values, ["DVA"], samples=1000)
    asked = "--sample 1 --range MU=.7..0.9 --outputs DVA --samples 1000".split()
    assert shown(answer) == printed(capsys, "bounds", *asked)


def test_reconstructions(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    values = impact88.sample(1).numbers()
    after = impact88.solve(values, impact88.names.FINAL_VELOCITIES)
    known: dict[str, Any] = {n: x for n, x in values.items() if n not in impact88.names.VELOCITIES}
    known |= {n: impact88.Uncertain("uniform", x, x - 1, x + 1) for n, x in after.items()}
    path = tmp_path / "known.toml"
    path.write_text(
        "".join(
            f"{n} = {x}\n" if isinstance(x, float) else f'{n} = "{x.low:.17g} .. {x.high:.17g}"\n'
            for n, x in known.items()
        )
    )
    answer = impact88.reconstruct(known)
    assert len(answer) == 2
    assert shown(answer) == printed(capsys, "reconstruct", "--full", "--samples", "0", str(path))


def test_figure_of_a_scene() -> None:
    """Text that a file can hold, and a picture where a notebook asks for one."""
    text = impact88.scene_svg(impact88.sample(1))
    assert text._repr_svg_() == text
    assert text.startswith("<svg")
