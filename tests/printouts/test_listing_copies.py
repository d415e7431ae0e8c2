"""An office's own copy of the listing: its pages are what it prints, and no others."""

from __future__ import annotations

import io
import json
import random
import re
from pathlib import Path

import numpy as np
import pytest
import scanpages
from captures import ROOT
from longer import long_but

import printouts
from impact88.apple.emulator.emulator import Applesoft
from impact88.collision.casescene import sample
from impact88.errors import UserError
from impact88.interface.commands.cli import main
from impact88.printouts.explaining import explanations
from impact88.printouts.judging import beside
from impact88.printouts.judging.copies import CopyPages
from impact88.printouts.reporting.examination import Verdict, examine
from impact88.printouts.reporting.verification import summary
from impact88.program.copies import ListingCopy
from impact88.program.run import page as on_paper
from impact88.program.run import run

LISTING = (ROOT / "legacy" / "impact.bas").read_text(encoding="utf-8")
INT = re.compile(r"INT \(((?:[^()]|\([^()]*\))*)\)")
SETTLED = (Verdict.IDENTICAL, Verdict.IDENTICAL_AS_READ)


def line(number: int) -> str:
    (text,) = re.findall(rf"(?m)^{number} .*$", LISTING)
    return str(text)


def changed(*lines: tuple[int, str]) -> str:
    text = LISTING
    for number, new in lines:
        text = text.replace(line(number), new)
    return text


def rounding(*numbers: int) -> str:
    """The results of some lines rounded to the nearest."""
    return changed(*((number, INT.sub(r"INT (\1 + .5)", line(number))) for number in numbers))


COPIES = {
    "one line rounds": rounding(760),
    "all lines round": rounding(660, 670, 690, 730, 740, 760),
    "pi": LISTING.replace("3.14159265", "3.1416"),
    "other data": changed((280, "280 E = .1:MU = .5:EM = - 1"), (290, line(290) + ": REM OURS")),
    "READ and DATA": changed(
        (280, "280 READ E,MU,EM: DATA .1,.5,-1"),
        (290, "290 READ DA,DB,GA,PA,PB,TA,TB"),
        (310, "310 READ MA,MB,IA,IB: DATA 1,2,3,4,5,6,7,100,90,2000,1000"),
    ),
    "INPUT": changed(
        (280, '280 INPUT "E,MU,EM ";E,MU,EM'),
        (290, "290 INPUT DA,DB: INPUT GA,PA,PB,TA,TB"),
        (310, "310 INPUT MA,MB,IA,IB"),
    ),
    "other order": changed((730, "731" + line(740)[3:]), (740, "742" + line(730)[3:])),
    "80 columns": changed((610, line(610) + ': PRINT CHR$ (9);"80N"')),
}


SHORT = ("other order",)
"""Copies that are run by default; in a sweep all. Tests below run others."""


def copy_of(text: str, folder: Path) -> ListingCopy:
    path = folder / "office.bas"
    path.write_text(text, encoding="utf-8")
    return ListingCopy(str(path))


@pytest.fixture
def verdicts_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """What stands beside a verdict is left out: it takes a hundred runs of the copy, and has tests
    of its own below."""
    monkeypatch.setattr(beside, "unseen", lambda *given: [])
    monkeypatch.setattr(explanations, "explain_copy", lambda *given: [])


def verdicts(text: str, copy: ListingCopy | None) -> set[Verdict]:
    return {result.verdict for result in examine("-", None, copy, data=text.encode()).results}


@pytest.mark.usefixtures("verdicts_alone")
@pytest.mark.captures
@pytest.mark.parametrize("name", COPIES if printouts.SWEEP else SHORT)
def test_the_pages_of_a_copy_are_settled_and_others_are_not(name: str, tmp_path: Path) -> None:
    rng = random.Random(name)
    copy = copy_of(COPIES[name], tmp_path)
    for row in rng.sample(printouts.normal_ends(), printouts.SWEEP or 1):
        page = printouts.body(copy.run(row["scene"]).page)
        assert verdicts(page, copy) <= set(SETTLED)
        places = [one.start() for one in re.finditer(r"(?<=VAY= )-?[0-9.]+", page)]
        at = next(at for at in range(places[0], len(page)) if page[at].isdigit())
        digit = rng.choice([one for one in "123456789" if one != page[at]])
        assert not verdicts(page[:at] + digit + page[at + 1 :], copy) & set(SETTLED)


@pytest.mark.long
def test_a_copy_is_held_against_the_restored_listing(tmp_path: Path, capsys) -> None:  # type: ignore[no-untyped-def]
    """And a slip in an angle is ranked by the copy's own pi."""
    copy = copy_of(rounding(760).replace("3.14159265", "3.14"), tmp_path)
    main(["run", "--sample", "1", "--listing", str(tmp_path / "office.bas")])
    page = tmp_path / "page.txt"
    page.write_text(capsys.readouterr().out, encoding="utf-8")
    assert main(["verify", str(page), "--listing", str(tmp_path / "office.bas"), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["verdict"] == "identical"
    assert [one["line"] for one in found["listing"]["lines"]] == [300, 760]
    assert found["listing"]["sha256"] == copy.sha256
    assert found["findings"][0].startswith("this page is what the copy")
    assert re.search("the restored listing prints .*WAF", found["findings"][0])
    page.write_text(page.read_text("utf-8").replace("-38.7", "-33.7"), encoding="utf-8")
    assert main(["verify", str(page), "--listing", str(tmp_path / "office.bas"), "--json"]) == 1
    (cause, *_) = json.loads(capsys.readouterr().out)["explanations"]
    assert (cause["kind"], cause["field"], cause["would_be"]) == ("digit misread", "PB", "-38.7")


@pytest.mark.captures
def test_rounding_on_one_line_comes_before_a_misread_digit(tmp_path: Path) -> None:
    copy = copy_of(COPIES["one line rounds"], tmp_path)
    named = []
    for row in random.Random(1).sample(printouts.normal_ends(), printouts.SWEEP or 1):
        page = printouts.body(copy.run(row["scene"]).page)
        for result in examine("-", data=page.encode()).results:
            if result.verdict is Verdict.DIFFERS:
                first = result.explanations[0]
                named.append((first.kind, first.note.partition(";")[0]))
    assert set(named) == {("rounded, not floored", "on line 760")}


@pytest.mark.usefixtures("verdicts_alone")
def test_a_mark_that_the_copy_does_not_print_is_not_missed(tmp_path: Path) -> None:
    copy = copy_of(changed((690, line(690).removesuffix(';" %"'))), tmp_path)
    page = copy.run(sample(1)).page
    assert "%" not in page
    assert verdicts(page, copy) == {Verdict.IDENTICAL}
    assert verdicts(page, None) == {Verdict.IDENTICAL_AS_READ}
    assert verdicts(page.replace("MA= ", "MA "), copy) == {Verdict.IDENTICAL_AS_READ}


@pytest.mark.usefixtures("verdicts_alone")
@pytest.mark.captures
def test_what_only_the_copy_prints_is_part_of_its_page(tmp_path: Path) -> None:
    """Its prompts, and the replies to them, to the digit."""
    copy = copy_of(COPIES["INPUT"], tmp_path)
    page = copy.run(sample(1)).page
    assert verdicts(page, copy) == {Verdict.IDENTICAL}
    altered = page.replace("143.5,95.8", "148.5,95.8", 1)
    assert verdicts(altered, copy) == {Verdict.DIFFERS}


@pytest.mark.long
def test_what_a_page_cannot_show_is_what_the_copy_cannot(tmp_path: Path) -> None:
    """One that forgets PB shows nothing of it."""
    copy = copy_of(LISTING.replace("TB + PB", "TB"), tmp_path)
    page = printouts.body(copy.run(sample(1)).page)
    (result,) = examine("-", None, copy, data=page.encode()).results
    assert result.verdict in SETTLED
    assert result.unseen[0].startswith("PB: nothing else on the page depends on it")


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "holds no program"),
        ("no numbers here", "not an Applesoft program"),
        ("10 INPUT A$: GOTO 10", "asks for more"),
        ("10 GOTO 10", "does not end"),
    ],
)
def test_what_is_no_copy_is_refused(text: str, says: str, tmp_path: Path) -> None:
    with pytest.raises(UserError, match=says):
        copy_of(text, tmp_path).run({})


@pytest.mark.long
def test_a_line_retyped_wrong_is_named(tmp_path: Path) -> None:
    """Without the copy at hand: the page itself shows which line is another."""
    wrong = copy_of(changed((490, line(490).replace("- 2 * EM", "+ 2 * EM"))), tmp_path)
    page = printouts.body(wrong.run(sample(1)).page)
    (result,) = examine("-", data=page.encode()).results
    first = result.explanations[0]
    assert first.kind == "a changed line of the listing"
    assert first.note.startswith("line 490: A66 = 1 + 2*em, should be 1 - 2*em")


def test_a_copy_that_prints_nothing_is_refused(tmp_path: Path) -> None:
    copy = copy_of(re.sub(r"PRINT[^:\n]*", "REM", LISTING), tmp_path)
    found = examine("-", None, copy, data=run(sample(1)).page.encode())
    assert "office.bas: no printout of the program" in (found.error or "")


# --- copies as offices have them: their pages made as a person runs them -------------------------


def renamed(text: str, pairs: dict[str, str]) -> str:
    """Variables renamed outside quotes."""

    def replaced(part: str) -> str:
        return re.sub(r"[A-Z][A-Z0-9]*", lambda word: pairs.get(word[0], word[0]), part)

    parts = [re.split(r'(".*?")', row) for row in text.split("\n")]
    return "\n".join(
        "".join(part if part.startswith('"') else replaced(part) for part in row) for row in parts
    )


REPLIES = ["-29.04,0,0", "14.52,25.15,0"]
IN_MPH = ["-19.8,0,0", "9.9,17.15,0"]
OFFICES: dict[str, tuple[str, list[str]]] = {
    "velocities renamed": (renamed(LISTING, {"UX": "V1", "UY": "V2", "WA": "W1"}), REPLIES),
    "inputs renamed": (
        renamed(LISTING, {"MA": "M1", "MB": "M2", "EM": "R", "PA": "P1", "M": "Q"}), REPLIES
    ),
    "converted in place": (
        changed(
            (210, "210 INPUT UX,UY,WA:UX = UX * 1.46667:UY = UY * 1.46667"),
            (230, "230 INPUT VX,VY,WB:VX = VX * 1.46667:VY = VY * 1.46667"),
        ),
        IN_MPH,
    ),
    "converted from others": (
        changed(
            (210, "210 INPUT S1,S2,WA:UX = S1 * 1.46667:UY = S2 * 1.46667"),
            (230, "230 INPUT S3,S4,WB:VX = S3 * 1.46667:VY = S4 * 1.46667"),
        ),
        IN_MPH,
    ),
    "weights": (
        changed(
            (310, "310 INPUT W1,W2:MA = W1 / 32.2:MB = W2 / 32.2:IA = 3728:IB = 1961"),
        ),
        [*REPLIES, "4620,3085"],
    ),
}  # fmt: skip


def run_as_a_person(text: str, replies: list[str], *, dos: bool = False) -> str:
    machine = Applesoft(dos=dos)
    machine.load(text)
    machine.feed(*replies)
    machine.run()
    return machine.take_output()


@pytest.mark.usefixtures("verdicts_alone")
@pytest.mark.parametrize("name", long_but(OFFICES, kept=(1,)))
def test_pages_of_an_office_are_settled_by_its_copy(name: str, tmp_path: Path) -> None:
    text, replies = OFFICES[name]
    page, copy = run_as_a_person(text, replies), copy_of(text, tmp_path)
    without_prompts = page[page.index("MA= ") :]
    assert verdicts(page, copy) <= set(SETTLED)
    assert verdicts(without_prompts, copy) <= set(SETTLED)
    assert verdicts(without_prompts.replace("VAY= ", "VAY= 1"), copy) == {Verdict.DIFFERS}
    assert verdicts(page.replace(replies[0], replies[0] + "5"), copy) == {Verdict.DIFFERS}


@pytest.mark.long
def test_a_page_of_a_converting_copy_is_told_in_words_first() -> None:
    page = run_as_a_person(*OFFICES["converted in place"])
    (result,) = examine("-", data=page.encode()).results
    assert result.verdict is Verdict.DIFFERS
    first, second, *_ = summary(result)
    assert "each velocity printed is 1.46667 times the reply" in first
    assert "--listing" in second


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (changed((190, '190 INPUT "SLOT ";S')), r"asks for S \(INPUT\)"),
        (
            renamed(LISTING, {"MA": "Z"}).replace('"MA= "', '"MASS "').replace("310 Z", "311 Z"),
            "MA: no variable",
        ),
    ],
)
def test_a_copy_whose_variables_are_not_plain_is_refused_by_name(
    text: str, says: str, tmp_path: Path
) -> None:
    page = run(sample(1)).page
    found = examine("-", None, copy_of(text, tmp_path), data=page.encode())
    assert re.search(says, found.error or "")


def pictured(page: str, font: str) -> bytes:
    """A page drawn as a scanner would have it."""
    from PIL import Image

    paper = scanpages.drawn(page.strip("\n").split("\n"), font, 36)
    grey = np.clip(scanpages.worn(paper, random.Random(page), "clean"), 0, 255)
    file = io.BytesIO()
    Image.fromarray(grey.astype(np.uint8)).save(file, "PNG", compress_level=1)
    return file.getvalue()


@pytest.fixture
def font() -> str:
    pytest.importorskip("scipy", reason="the extra scan is not installed")
    pytest.importorskip("PIL", reason="the extra scan is not installed")
    if not scanpages.fonts():
        pytest.skip("none of the drawer's fonts is installed")
    return scanpages.fonts()[0]


@pytest.mark.long
@pytest.mark.usefixtures("verdicts_alone")
@pytest.mark.parametrize("name", ["weights", "converted in place", "one line rounds"])
def test_a_picture_is_settled_by_the_copy_that_printed_it(
    name: str, font: str, tmp_path: Path
) -> None:
    """Not by another, nor with a digit altered; a line of the copy's own belongs to the page."""
    text, replies = OFFICES[name] if name in OFFICES else (COPIES[name], REPLIES)
    page, copy = on_paper(run_as_a_person(text, replies, dos=True)), copy_of(text, tmp_path)
    (genuine,) = examine("-", None, copy, data=pictured(page, font)).results
    assert genuine.verdict is Verdict.IDENTICAL
    scene, listed = genuine.complete_scene, [one["line"] for one in genuine.copy["lines"]]  # type: ignore[index]
    assert scene["UX"] == "-29.04" or "converted" in name
    assert genuine.findings[0].startswith("this page is what the copy")
    assert listed
    results = page.index("VAX= ")
    altered = page[:results] + page[results:].replace("7", "4", 1)
    found = examine("-", None, copy, data=pictured(altered, font)).results
    assert {one.verdict for one in found}.isdisjoint(SETTLED)
    (other,) = examine("-", data=pictured(page, font)).results
    assert other.verdict not in (SETTLED if name != "weights" else (Verdict.IDENTICAL,))


def test_a_copy_with_another_layout_is_refused_for_pictures(font: str, tmp_path: Path) -> None:
    page = pictured(run(sample(1)).page, font)
    for text, says in (
        (COPIES["other order"], "in another order than the listing: 'VBX= #"),
        (LISTING.replace('"DA= "', '"ARM A= "'), "no line laid out like the listing's 'DA= # DB="),
    ):
        found = examine("-", None, copy_of(text, tmp_path), data=page)
        assert says in (found.error or "")


def test_lines_that_only_the_copy_prints_are_known_for_its_scene(tmp_path: Path) -> None:
    pages = CopyPages(copy_of(OFFICES["weights"][0], tmp_path))
    scene = {**sample(1), "MA": "4620", "MB": "3085"}
    assert pages.prints("? 4620,3085", scene)
    assert not pages.prints("?4620,30850", scene)
    assert not pages.prints("?4621,3085", scene)
    assert not pages.prints("?4?20,3085", scene)
    assert not pages.prints("DA= 7.59 DB= 3.44", scene)


@pytest.mark.usefixtures("verdicts_alone")
@pytest.mark.parametrize("width", [33, 40])
def test_a_copy_as_list_printed_it_is_held_against(width: int, tmp_path: Path) -> None:
    machine = Applesoft()
    machine.load(COPIES["one line rounds"])
    machine.enter("LIST" if width == 33 else "POKE 33,33: LIST")
    listed = machine.take_output()
    page = copy_of(COPIES["one line rounds"], tmp_path).run(sample(1)).page
    assert verdicts(page, copy_of(listed, tmp_path)) == {Verdict.IDENTICAL}
