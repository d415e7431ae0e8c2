"""The page for the case file: what stands on it, and that it stays the same."""

from __future__ import annotations

import csv
import io
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from longer import long_but

from impact88 import solve
from impact88.casework.reconstruction import adjustment
from impact88.collision.casescene import sample
from impact88.interface.commands.cli import main
from impact88.names import quantity

pytest.importorskip("jinja2")

SCENE = {
    **sample(1),
    **{"UX": "-19.8 +- 2 mph", "VX": "9.9 mph", "VY": "17.1477 mph", "UY": "0", "GA": "-30 +- 5"},
    **{"MA": "4,617 lb", "MB": "3,082 lb", "DA": "7 ft 7 in"},
    **{"LA": "16 ft 2 in", "BA": "6 ft 3 in"},
}
KNOWN = {
    **{"MA": "96 slug", "MB": "145 slug", "IA": "1970 slug ft2", "IB": "3770 slug ft2"},
    **{"DA": "4.5", "DB": "4", "GA": "0", "PA": "0", "PB": "-40", "TA": "0", "TB": "90"},
    **{"UY": "0", "VX": "0", "VAX": "-10 +- 2 ft/s", "VAY": "20 +- 2 ft/s"},
    **{"VBX": "-20 +- 2 ft/s", "VBY": "45 +- 2 ft/s"},
}
HEAD = 'units = "us"\ncase = "24-117 <b>"\ntitle = "Main and 4th"\n'


def written(tmp_path: Path, entries: dict[str, str], *options: str) -> str:
    source, page = tmp_path / "case.toml", tmp_path / "case.html"
    lines = [f'{name} = "{text}"' for name, text in entries.items()]
    source.write_text(HEAD + "\n".join(lines) + '\nMA_source = "scale ticket"\n', encoding="utf-8")
    assert main(["report", str(source), "-o", str(page), "--samples", "300", *options]) == 0
    return page.read_text("utf-8")


def plain(page: str) -> str:
    return re.sub(r"\s+", " ", re.sub(r"<[^>]+>", " ", page.partition("</style>")[2]))


def rows_of(page: str) -> list[list[str]]:
    """The texts of every row of the page's tables."""
    return [re.findall(r"<td[^>]*>(.*?)</td>", row) for row in page.split("<tr>")]


@pytest.fixture(scope="module")
def forward(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the report of SCENE: case.toml, case.html."""
    folder = tmp_path_factory.mktemp("forward")
    written(folder, SCENE, "--paper", "a4")
    return folder


def test_a_scene_is_answered_forward_in_its_units(forward: Path) -> None:
    page = (forward / "case.html").read_text("utf-8")
    text = plain(page)
    assert "Main and 4th" in text
    assert "Case 24-117 &lt;b&gt;" in text
    assert re.search(
        r"A: speed before 19.8 mph, after 9\.\d+ mph \(sd 0\.\d+\), ΔV 1[01]\.\d mph \(sd \d", text
    )
    assert "scale ticket" in text
    assert "4,617 lb" in text
    assert "7 ft 7 in" in text
    assert "length/time" not in text
    assert re.search(r"SHA-256.*[0-9a-f]{64}", text)
    assert "signature" in text
    assert 'content: "page " counter(page) " of " counter(pages)' in page


def test_a_file_with_unknowns_is_reconstructed(tmp_path: Path, capsys: Any) -> None:
    text = plain(written(tmp_path, KNOWN))
    assert re.search(r"BEFORE IMPACT A 27\.\d mph, heading 180, 90 % 2\d[.\d]* to 2", text)
    assert "NOT FOUND spins, E, EM: give" in text
    assert "adjusted by least squares" in text


def test_a_page_without_a_drawing_has_its_answer_once(tmp_path: Path) -> None:
    """With both vehicles' speeds before and changes of velocity as its numbers, whose standard
    deviation and bounds are named."""
    ways = {"HA": "0", "HB": "-90", "HAF": "-40", "SBF": "30 mph", "HBF": "-30"}
    masses = {"M": "4", "MA": "4000 lb", "MB": "2600 lb", "SAF": "50 +- 5 mph"}
    signed = ("--examiner", "N. N", "--date", "1 May")
    page = written(tmp_path, {**masses, **ways}, *signed)
    assert "Not drawn" in page
    assert page.count("lower bound") == 1
    numbers = re.findall(r"<div><b>(.*?)</b>(.*?)</div>", page)
    assert [meaning.partition("<br>")[0] for _, meaning in numbers] == [
        quantity(name).meaning.replace("'", "&#39;") for name in ("SA", "SB", "DVA", "DVB")
    ]
    for amount, below in numbers:
        assert "±" not in amount
        assert re.search(r"sd [\d.]+, bounds [\d.]+ to [\d.]+, 90 % within", below)
    assert "Examiner: N. N. 1 May." in plain(page)


def test_the_answer_is_what_the_commands_say(forward: Path, capsys: Any) -> None:
    rows = rows_of((forward / "case.html").read_text("utf-8"))
    (found,) = [row for row in rows if row[:1] == ["DVA"] and len(row) == 9]
    capsys.readouterr()
    words = ["bounds", str(forward / "case.toml"), "--samples", "300", "--json"]
    assert main([*words, "--outputs", "DVA"]) == 0
    expected = json.loads(capsys.readouterr().out)["outputs"]["DVA"]
    numbers = [expected["nominal"], expected["deviation"], expected["quantiles"]["0.05"]]
    numbers += [expected["quantiles"]["0.95"], expected["lower"], expected["upper"]]
    assert [float(cell) for cell in found[2:8]] == pytest.approx(numbers, abs=0.051)
    (speed,) = [row for row in rows if row[:1] == ["SAF"] and len(row) == 9]
    value, deviation, low, high = map(float, speed[2:6])
    assert low < value < high
    assert deviation == pytest.approx((high - low) / 3.3, rel=0.3)
    assert speed[6:] == ["", "", "mph"]
    assert found[8] == expected["unit"] == "mph"


def test_friction_as_a_share_is_that_of_the_other_commands(tmp_path: Path, capsys: Any) -> None:
    rows = rows_of(written(tmp_path, {**SCENE, "MU": "50 %", "GA": "-30"}))
    found = next(row[2] for row in rows if row[:1] == ["DVA"])
    capsys.readouterr()
    assert main(["solve", str(tmp_path / "case.toml"), "--outputs", "DVA"]) == 0
    (row,) = csv.DictReader(io.StringIO(capsys.readouterr().out))
    assert float(found) == pytest.approx(float(row["DVA [mph]"]), abs=0.06)


def test_what_is_taken_as_given_is_said(tmp_path: Path) -> None:
    page = written(tmp_path, SCENE)
    told = page[page.index("Not judged") : page.index("Validation</h2>")]
    assert "Taken as exact" in told
    assert "The file names no source for" in told
    assert " MA " not in told.partition("names no source for")[2]


def test_the_same_input_gives_the_same_bytes_and_no_file_is_missed(forward: Path) -> None:
    page = (forward / "case.html").read_text("utf-8")
    assert page != written(forward, SCENE, "--paper", "a4", "--seed", "1")
    assert page == written(forward, SCENE, "--paper", "a4")
    assert "210mm 297mm" in page
    addresses = set(re.findall(r"https?://[^\"' <]+", page))
    assert addresses <= {"http://www.w3.org/2000/svg"}
    assert not re.search(r"<(link|script|img|iframe)\b", page)


def test_without_jinja2_one_line_says_what_to_install(
    tmp_path: Path, monkeypatch: Any, capsys: Any
) -> None:
    monkeypatch.setitem(sys.modules, "jinja2", None)
    source = tmp_path / "case.toml"
    source.write_text(sample(1).to_toml(), encoding="utf-8")
    assert main(["report", str(source), "-o", str(tmp_path / "x.html")]) == 2
    assert "pip install 'impact88[report]'" in capsys.readouterr().err
    assert not (tmp_path / "x.html").exists()


def test_a_sample_and_changed_values(tmp_path: Path, capsys: Any) -> None:
    page = tmp_path / "case.html"
    asked = ["report", "-o", str(page), "--samples", "0"]
    assert main([*asked, "--sample", "1", "--set", "MU=.5"]) == 0
    text = page.read_text("utf-8")
    assert "changed with --set" in text
    assert "44.4" in text  # percent of the kinetic energy, as in the guide
    assert main(asked) == 2
    assert "expected one scene" in capsys.readouterr().err


@pytest.mark.parametrize("name", ["x.pdf", "x.docx", "x.PDF", "x.txt"])
def test_a_page_is_not_written_under_another_formats_name(
    tmp_path: Path, capsys: Any, name: str
) -> None:
    path = tmp_path / name
    assert main(["report", "--sample", "1", "-o", str(path)]) == 2
    assert main(["verify", str(tmp_path / "p.txt"), "--report", str(path)]) == 2
    said = capsys.readouterr().err
    assert said.count("expected a name that ends in .html") == 2
    assert not path.exists()


def test_what_does_not_print_is_shown_with_escapes(tmp_path: Path) -> None:
    source, page = tmp_path / "case.toml", tmp_path / "case.html"
    lines = [f'{name} = "{value}"' for name, value in sample(1).items()]
    head = ['title = "Main \\u001b[31m and \\u202e4th"', 'case = "7\\u0007"']
    source.write_text("\n".join([*head, *lines, 'MA_source = "a\\u202eb"']), encoding="utf-8")
    assert main(["report", str(source), "-o", str(page), "--samples", "0"]) == 0
    text = page.read_text("utf-8")
    assert text.replace("\n", "").isprintable()
    assert r"Main \x1b[31m and \u202e4th" in text
    assert r"Case 7\x07" in text
    assert r"a\u202eb" in text


def first_page(page: str) -> str:
    """The words of the first page."""
    return plain(
        "</style>" + page.partition('<section class="page1">')[2].partition("</section>")[0]
    )


MEASURED = {"SAF": 2.0, "SBF": 2.0, "WAF": 0.3, "WBF": 0.3, "HAF": 5.0, "HBF": 5.0}
"""Standard deviations of what is measured after the impact, in the sample's units."""


def evidence_file(folder: Path, seed: int, off: float) -> tuple[Path, Path]:
    """A file of what would be measured after sample 1, its geometry, e, friction and e_m known;
    one measurement is off by so many deviations."""
    rng = np.random.default_rng(seed)
    scene = sample(1).numbers()
    after = {name: float(value) for name, value in solve(scene).items()}
    true = {f"S{v}F": np.hypot(after[f"V{v}X"], after[f"V{v}Y"]) for v in "AB"}
    true |= {f"H{v}F": np.degrees(np.arctan2(after[f"V{v}Y"], after[f"V{v}X"])) for v in "AB"}
    true |= {"WAF": after["WAF"], "WBF": after["WBF"]}
    wrong = list(MEASURED)[seed % len(MEASURED)]
    lines = ['units = "chapter"']
    kept = [n for n in scene if n not in ("UX", "UY", "WA", "VX", "VY", "WB")]
    lines += [f"{name} = {float(scene[name])!r}" for name in kept]
    lines += ["WA = 0", "WB = 0", "HA = 180", "HB = 60"]
    for name, sd in MEASURED.items():
        value = true[name] + sd * np.clip(rng.normal(), -1, 1) * 0.7 + off * sd * (name == wrong)
        lines.append(f'{name} = "normal {value:.4f} {sd}"')
    source = folder / f"{seed}-{off:g}.toml"
    source.write_text("\n".join(lines), encoding="utf-8")
    return source, source.with_suffix(".html")


FILES = 50 if os.environ.get("IMPACT88_SWEEP") else 1


@pytest.fixture
def searched_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two commands that are asked the same have one search."""
    results: dict[str, Any] = {}

    def reconstruct(known: Any, *progress: Any) -> Any:
        key = repr(sorted(known.items()))
        if key not in results:
            results[key] = adjustment_reconstruct(known, *progress)
        return results[key]

    adjustment_reconstruct = adjustment.reconstruct
    monkeypatch.setattr(adjustment, "reconstruct", reconstruct)


@pytest.mark.usefixtures("searched_once")
@pytest.mark.parametrize("seed", range(FILES))
@pytest.mark.parametrize("off", long_but([0.0, 40.0], kept=(1,)))
def test_the_first_page_says_that_the_evidence_contradicts_itself_or_does_not(
    tmp_path: Path, capsys: Any, seed: int, off: float
) -> None:
    """The first page has the verdict of the command, the word only where it holds."""
    source, page = evidence_file(tmp_path, seed, off)
    assert main(["report", str(source), "-o", str(page), "--samples", "0"]) == bool(off)
    words = first_page(page.read_text("utf-8"))
    assert ("contradict" in words) == bool(off), words
    capsys.readouterr()
    assert main(["reconstruct", str(source), "--json", "--samples", "0"]) in (0, 1)
    told = json.loads(capsys.readouterr().out)
    verdicts = {row["evidence"]["text"] for row in told["solutions"][:1]}
    assert all(text in words for text in verdicts)


@pytest.mark.long
@pytest.mark.parametrize("seed", range(FILES) if FILES > 1 else [1])
@pytest.mark.parametrize("off", [0.0, 40.0])
def test_the_first_page_is_one_page_and_well_filled(tmp_path: Path, seed: int, off: float) -> None:
    """As a browser prints it: of the height between the margins four fifths are used."""
    browser = shutil.which("chromium") or shutil.which("google-chrome")
    pypdfium2 = pytest.importorskip("pypdfium2")
    if not browser:
        pytest.skip("no Chromium")
    source, page = evidence_file(tmp_path, seed, off)
    assert main(["report", str(source), "-o", str(page), "--samples", "200"]) == bool(off)
    printed = tmp_path / "x.pdf"
    subprocess.run(
        [
            *(browser, "--headless", "--no-sandbox", "--disable-gpu", "--no-pdf-header-footer"),
            *(f"--print-to-pdf={printed}", str(page)),
        ],
        check=True,
        capture_output=True,
        timeout=120,
    )
    paper = pypdfium2.PdfDocument(printed)
    first = paper[0].get_textpage().get_text_range()
    assert ("contradict one another" in " ".join(first.split())) == bool(off)
    assert "Answer" in paper[1].get_textpage().get_text_range()
    dark = np.asarray(paper[0].render(scale=0.5).to_pil().convert("L")) < 160
    rows = np.flatnonzero(dark.any(1)) * 2 / 72 * 25.4  # mm
    rows = rows[rows < 279.4 - 20]  # above the page's number
    assert rows[0] < 30
    assert rows[-1] - 18 >= 0.8 * (279.4 - 38)


REAR_END = {
    **{"M": "6", "MA": "3000 lb", "MB": "3500 lb", "IA": "1800 slug ft2", "IB": "2300 slug ft2"},
    **{"DA": "6.5 ft", "DB": "5 ft", "E": "uniform 0 0.3", "EM": "0", "MU": "0.4", "GA": "0"},
    **{"PA": "0", "PB": "0", "TA": "0", "TB": "0", "WA": "0", "WB": "0", "UY": "0"},
    **{"SAF": "12 +- 1.5 mph", "SBF": "17 +- 1.5 mph"},
}
"""B may have stood; EM = 0 makes the friction given more than the sliding takes."""


@pytest.mark.long
@pytest.mark.usefixtures("brief_search")
def test_a_car_that_fits_best_standing_has_no_speed_of_rounding(tmp_path: Path) -> None:
    """Neither a course of who stands, nor ± about a value outside 90 % of the draws, nor digits of
    rounding; that it breaks physics is said on the first page."""
    page = written(tmp_path, {**REAR_END, "VX": "0 +- 1 mph", "VY": "0 +- 1 mph"})
    first, text = first_page(page), plain(page)
    assert not re.search(r"\de-\d\d", text.partition("Method")[0])
    assert re.search(r"\d to \d\.\d+ mph initial speed of B 90 % of the draws; [\d.]+ fits", first)
    assert re.search(r"POSSIBLE impacts that physics allows.* SB [\d.]+ to [\d.]+ mph", first)
    assert "IMPOSSIBLE" in first
    assert "settle nothing" in first
    page = written(tmp_path, {**REAR_END, "VX": "0", "VY": "0"})
    assert "initial speed of B" not in first_page(page)  # given, if not by that name
    assert "course of B before impact" not in plain(page)
    # A drives backwards, away from B, in the mirrored one
    assert "UX is about" not in plain(page)


def test_the_drawing_of_the_first_page_says_nothing_twice(forward: Path) -> None:
    """Numbers and remarks stand beside it."""
    page = (forward / "case.html").read_text("utf-8")
    drawn = page.partition("<figure>")[2].partition("</figure>")[0]
    assert "velocity before" in drawn
    assert "speed before" not in drawn
    assert "Remark" not in drawn


POINTS = {"M": "4", "MA": "3000 lb", "MB": "4000 lb", "TA": "course", "TB": "course"}


def page_of(tmp_path: Path, entries: dict[str, str]) -> tuple[int, str]:
    """The exit status of the report on some values, and the words of its page."""
    source, page = tmp_path / "case.toml", tmp_path / "case.html"
    lines = [f'{name} = "{text}"' for name, text in entries.items()]
    source.write_text("\n".join(['units = "us"', *lines]), encoding="utf-8")
    status = main(["report", str(source), "-o", str(page), "--samples", "300"])
    return status, plain(page.read_text("utf-8"))


def test_a_scene_that_gains_energy_is_refused_first(tmp_path: Path) -> None:
    """The gain of energy is (e² - 1) m v² / 2 = .44 · (1714.3 lb / 32.174) · (44 ft/s)² / 2 =
    22,694 ft-lb, 1714.3 lb the reduced mass of 3000 and 4000 lb, and 44 ft/s 30 mph."""
    scene = {**POINTS, "UX": "-30 mph", "UY": "0", "VX": "0", "VY": "0", "GA": "0", "MU": "0"}
    status, text = page_of(tmp_path, {**scene, "E": "1.2"})
    assert status == 1
    told = "agrees with what is known: energy of 2.27e+04 ft-lb is gained. E = 1.2 was given; 1 is"
    assert told in text
    assert text.index("NO IMPACT") < text.index("Found:")
    status, text = page_of(tmp_path, {**scene, "E": "0.8"})
    assert status == 0
    assert "NO IMPACT" not in text


def test_impacts_that_physics_forbids_are_not_counted_with_those_that_agree(
    tmp_path: Path,
) -> None:
    """At most a change of 30 mph · 4/7 · (1 + 1) = 34.29 mph is possible for A: 36 breaks physics,
    forwards and backwards."""
    known = {**POINTS, "SA": "30 mph", "HA": "0", "SB": "0 mph", "DVA": "36 +- 1 mph"}
    text = page_of(tmp_path, known)[1]
    assert "2 impacts that physics forbids fit what is known besides" in text
    assert "impacts agree with what is known" not in text
