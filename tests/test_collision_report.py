"""The page for the case file: what stands on it, and that it stays the same."""

from __future__ import annotations

import csv
import json
import re
import sys
from pathlib import Path
from typing import Any

import pytest

from impact88.cli import main
from impact88.scene import sample

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


@pytest.fixture(scope="module")
def forward(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the report of SCENE: case.toml, case.html, t.csv."""
    folder = tmp_path_factory.mktemp("forward")
    written(folder, SCENE, "--paper", "a4", "--csv", str(folder / "t.csv"))
    return folder


def test_a_scene_is_answered_forward_in_its_units(forward: Path) -> None:
    page = (forward / "case.html").read_text("utf-8")
    text = plain(page)
    assert "Main and 4th" in text
    assert "Case 24-117 &lt;b&gt;" in text
    assert re.search(
        r"A: speed before 19.8 mph, after 9\.\d+ ± 0\.\d+ mph, ΔV 1[01]\.\d ± \d\.\d+ mph", text
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
    assert re.search(r"A: speed before 27\.\d ± 1\.\d mph", text)
    assert "not determined by what is known: WA WB WAF WBF" in text
    assert "adjusted by least squares" in text


def test_the_answer_is_what_the_commands_say(forward: Path, capsys: Any) -> None:
    rows = list(csv.reader((forward / "t.csv").open(encoding="utf-8")))
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
    written(tmp_path, {**SCENE, "MU": "50 %", "GA": "-30"}, "--csv", str(tmp_path / "t.csv"))
    rows = list(csv.reader((tmp_path / "t.csv").open(encoding="utf-8")))
    found = next(row[2] for row in rows if row[:1] == ["DVA"])
    capsys.readouterr()
    assert main(["solve", str(tmp_path / "case.toml"), "--outputs", "DVA", "--results-only"]) == 0
    assert float(found) == pytest.approx(float(capsys.readouterr().out.split()[-1]), abs=0.06)


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


def test_a_workbook(tmp_path: Path, capsys: Any) -> None:
    openpyxl = pytest.importorskip("openpyxl")
    written(tmp_path, KNOWN, "--xlsx", str(tmp_path / "t.xlsx"))
    book = openpyxl.load_workbook(tmp_path / "t.xlsx")
    assert book.sheetnames[:2] == ["Answer", "Inputs as given"]
    assert book["Answer"]["C2"].value == pytest.approx(27.4, abs=0.05)


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
