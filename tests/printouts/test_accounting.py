"""Every character of a text is one of matched, doubtful and left over, whatever stands on it."""

from __future__ import annotations

import random
import unicodedata
from collections import Counter

import dressedpages
import pytest
from longer import long_but

import impact88
import printouts
from impact88.printouts.reading.glyphs import Page
from impact88.printouts.reading.numerals import candidates
from impact88.printouts.reporting.examination import Verdict
from impact88.printouts.reporting.verification import DOUBTFUL, NOTES, lines, sections

pytestmark = pytest.mark.usefixtures("verdicts_alone")
PAGE = impact88.run(impact88.sample(1)).page
ALONE = "nothing else stands on the page"


def shown(text: str) -> int:
    """Characters that show: no blanks, and nothing that only controls what shows."""
    kinds = (unicodedata.category(char) for char in text if not char.isspace() and char != "\u00ad")
    return sum(kind not in ("Cc", "Cf") for kind in kinds) + text.count("\u00ad")


def check(text: str) -> impact88.Verifications:
    """Verify a text, and hold its account against its characters."""
    results = impact88.verify(text.encode())
    counted = sum(sum(result.characters.values()) for result in results)
    assert counted == shown(text)
    for result in results:
        said = "\n".join(lines(result))
        is_open = result.characters["doubtful"] or result.characters["left_over"]
        assert not (ALONE in said and is_open)
        if result.verdict is Verdict.IDENTICAL_AS_READ:
            parts = sections(result)
            assert parts.get(DOUBTFUL) or parts.get(NOTES)
    return results


def test_every_character_of_a_page_is_accounted_for() -> None:
    (result,) = check(PAGE)
    assert result.characters == {"matched": shown(PAGE), "doubtful": 0, "left_over": 0}
    assert ALONE in "\n".join(lines(result))


@pytest.mark.parametrize("name", long_but(dressedpages.DRESSES, kept=range(0, 30, 3)))
def test_a_genuine_page_in_any_dress_is_settled(name: str) -> None:
    for page in dressedpages.fresh_pages(printouts.SWEEP or 1, seed=11):
        dressed = dressedpages.DRESSES[name](page)
        (result,) = impact88.verify(dressed if isinstance(dressed, bytes) else dressed.encode())
        assert result.verdict in (Verdict.IDENTICAL, Verdict.IDENTICAL_AS_READ)
        if isinstance(dressed, str):
            check(dressed)


@pytest.mark.long
def test_an_altered_character_is_never_passed_over() -> None:
    """No bare IDENTICAL, unless the program prints exactly that for the scene that verify gives;
    and 85 % differ, or are doubted in the place that was altered."""
    scores = Counter[str]()
    for page in dressedpages.altered_pages(6 * (printouts.SWEEP or 10), seed=12):
        scores[dressedpages.score_of(page, check(page.text))] += 1
    assert not scores["IDENTICAL"]
    assert sum(scores[score] for score in dressedpages.FOUND) >= 0.85 * scores.total()


def test_any_text_is_accounted_for() -> None:
    """Pages with text put into them, cut, doubled, and side by side."""
    rng = random.Random(13)
    for _ in range(printouts.SWEEP or 12):
        text = "".join(rng.choice("aZ9.?-=%*(| \n") for _ in range(rng.randint(1, 60)))
        at, to = sorted(rng.sample(range(len(PAGE)), 2))
        for page in (PAGE[:at] + text + PAGE[at:], PAGE[:at] + PAGE[to:], PAGE + text + PAGE):
            try:
                check(page)
            except impact88.UserError:
                continue
    beside = zip(PAGE.split("\n"), PAGE.split("\n"), strict=True)
    assert len(check("\n".join(f"{left:60}{right}" for left, right in beside))) == 2


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("?-29.04,0,0", "?9X9X9,7X7,5X5"),
        ("?-29.04,0,0", "?-2X9.04,0,0"),
        ("?-29.04,0,0", "?-31X.04,0,0"),
        ("57.47 %", "57.47\n%"),
        ("VAX=", "VAX\n="),
        (" YA= 15.91)", " YA= 15.91\n)"),
        ("\n\nUX=", "\nM\nUX="),
        ("*****", "**7**"),
        ("LOSS", "LOAS"),
        ("INITIAL", "INITIQL"),
        ("VAX=", "VAX:"),
        ("\n\nVBX=", "\nALL SPEEDS IN MPH\nVBX="),
        ("\nUX=", "\n> UX="),
    ],
)
def test_what_the_program_does_not_print_bars_a_bare_identical(old: str, new: str) -> None:
    assert old in PAGE
    for result in check(PAGE.replace(old, new, 1)):
        assert result.verdict is not Verdict.IDENTICAL
        parts = sections(result)
        assert parts.get(DOUBTFUL) or parts.get(NOTES) or result.differing


@pytest.mark.parametrize("place", ["above", "below"])
@pytest.mark.parametrize("around", ["BROWN AND PARTNERS, FILE 88-1432\nPAGE 3 OF 7\n", "]\n"])
def test_text_around_the_page_bars_nothing(place: str, around: str) -> None:
    page = around + PAGE if place == "above" else PAGE + around
    (result,) = check(page)
    assert result.verdict is Verdict.IDENTICAL
    assert result.characters["left_over"] == shown(around)
    assert ALONE not in "\n".join(lines(result))


def test_replies_that_input_refuses_are_the_apples() -> None:
    page = PAGE.replace("?-29.04,0,0", "?-29.04,X,0\n?REENTER\n?-29.04,0,0", 1)
    (result,) = check(page)
    assert result.verdict is Verdict.IDENTICAL
    page = PAGE.replace("?-29.04,0,0", "?-31.04,0,0\n?REENTER\n?-29.04,0,0", 1)
    (result,) = check(page)
    assert result.verdict is not Verdict.IDENTICAL


@pytest.mark.parametrize("mass", ["0", "1E30"])
def test_nothing_is_said_of_results_that_are_not_there(mass: str) -> None:
    page = impact88.run(impact88.sample(1).replaced({"MA": mass})).page
    for text in (page, page.replace("MB= 95.8", "MB=")):
        for result in impact88.verify(text.encode()):
            said = "\n".join(lines(result))
            assert "results are those" not in said
            assert "recomputed: no error" not in said


@pytest.mark.parametrize(
    ("old", "new", "verdict"),
    long_but(
        [
            ("VAX= -13.263", "VAX= -13A.263", Verdict.DIFFERS),
            ("VAX= -13.263", "VAX= -1K.263", Verdict.DIFFERS),
            ("-29.04,0,0", "-2K.04,0,0", Verdict.DIFFERS),
            ("VAX= -13.263", "VAX= -13.26O", Verdict.DIFFERS),
            ("KE= 100904.929", "KE= 1O0904.929", Verdict.IDENTICAL_AS_READ),
            ("KE= 100904.929", "KE= 100,904.929", Verdict.IDENTICAL_AS_READ),
            ("VAX= -13.263", "VAX= -13.263G", Verdict.IDENTICAL_AS_READ),
            ("VAX= -13.263", "VAX= -?3.263", Verdict.IDENTICAL_AS_READ),
        ],
        kept=(0, 4, 6),
    ),
)
def test_a_letter_typed_into_a_number_contradicts(old: str, new: str, verdict: Verdict) -> None:
    """On a page with signs of an optical reader it is a doubt."""
    (result,) = check(PAGE.replace(old, new))
    assert result.verdict is verdict
    read = PAGE.replace("INITIAL KE", "1N1T1AL KE").replace("COMPONENTS", "C0MP0NENT5")
    (result,) = check(read.replace(old, new))
    assert result.verdict is Verdict.IDENTICAL_AS_READ


@pytest.mark.parametrize(
    ("old", "new", "told"),
    long_but(
        [
            ("?-29.04,0,0", "?", "no reply at the prompt of MA"),
            ("?14.52,25.15,0", "?", "no reply at the prompt of MB"),
            (
                "ENTER THE INITIAL VELOCITY COMPONENTS OF MA :Vax,Vay,Wa ?-29.04,0,0\n",
                "",
                "of MA is",
            ),
            (
                "ENTER THE INITIAL VELOCITY COMPONENTS OF MB :Vbx,Vby,Wb ?14.52,25.15,0\n",
                "",
                "of MB is",
            ),
        ],
        kept=(0, 3),
    ),
)
def test_a_prompt_or_reply_that_is_missing_is_told(old: str, new: str, told: str) -> None:
    (result,) = check(PAGE.replace(old, new))
    assert result.verdict is Verdict.IDENTICAL_AS_READ
    assert any(told in remark for remark in result.remarks)
    (result,) = check(PAGE[PAGE.index("MA= ") :])  # retyped without prompts
    assert result.verdict is Verdict.IDENTICAL


def test_decimal_commas_behind_a_zero_are_points() -> None:
    page = PAGE[PAGE.index("MA= ") :].replace(" .", " 0.").replace("-.", "-0.").replace(".", ",")
    (result,) = check(page)
    assert "MU= 0,911" in page
    assert result.verdict is Verdict.IDENTICAL_AS_READ
    assert candidates(Page("0,715").glyphs)[0][0] == ".715"
