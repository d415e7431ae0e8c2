"""Verdicts on pages that an optical reader read, and on pages with one thing wrong."""

from __future__ import annotations

import gzip
import json
from collections.abc import Iterator
from contextlib import suppress
from functools import cache, partial
from typing import Any

import pytest
from captures import ROOT
from longer import long_but

import printouts
from impact88.collision.casescene import sample
from impact88.collision.fields import INPUTS, outcome_fields
from impact88.errors import UserError
from impact88.printouts.judging import beside
from impact88.printouts.judging.judgement import Status
from impact88.printouts.judging.reader import is_reader_error
from impact88.printouts.reading import alignment, printout
from impact88.printouts.reading.numerals import printable
from impact88.printouts.reading.printout import Printout, read_printouts
from impact88.printouts.reporting.examination import Verdict, Verification, verify
from impact88.printouts.reporting.verification import EXPLAINED, sections, summary
from impact88.program.run import run
from printouts import SAMPLE, SWEEP, doubtful

SETTLED = (Verdict.IDENTICAL, Verdict.IDENTICAL_AS_READ)
UNSEEN = {"2-037"}
"""Altered in an angle that nothing printed depends on: the program prints just that page."""


def scans() -> list[dict[str, Any]]:
    """Pages read by an optical reader, with the text that was on the paper."""
    with gzip.open(ROOT / "golden" / "scans.jsonl.gz", "rt", encoding="utf-8") as file:
        return [json.loads(line) for line in file]


@pytest.fixture(autouse=True)
def verdicts_alone(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """What a page cannot show takes a good part of the time: only tests that ask for it have it."""
    if "whole" in request.fixturenames:
        return
    monkeypatch.setattr(beside, "unseen", lambda *given: [])


@pytest.fixture
def whole() -> Iterator[None]:
    """Verifications with what the page cannot show."""
    judged.cache_clear()
    yield
    judged.cache_clear()


@cache
def judged(text: str) -> list[Verification]:
    """The printouts of a text, fragments left out."""
    return [verify(shown) for shown in read_printouts(text) if not shown.fragment]


def one(text: str) -> Verification:
    (result,) = judged(text)
    return result


KEPT = scans()[:: 1 if SWEEP else 4]
SLOW = pytest.mark.skipif(not SWEEP, reason="IMPACT88_SWEEP is not set")


@pytest.mark.parametrize("page", long_but(KEPT, kept=(0, 1, 2)), ids=lambda page: page["name"])
def test_what_is_said_of_a_scan_is_true(page: dict[str, Any]) -> None:
    """Identical only where every number was read as printed; accused only where one was not; and
    what was altered on the paper is never settled."""
    try:
        results = judged(page["read"])
    except UserError:
        return
    for result, printed in zip(results, page["printed"], strict=False):
        paper = outcome_fields(printed)
        misread = [check.name for check in result.fields if check.printed != paper.get(check.name)]
        if result.verdict is Verdict.IDENTICAL:
            assert not misread
        if page["altered"] and page["name"] not in UNSEEN:
            assert result.verdict not in SETTLED
        elif result.verdict is Verdict.DIFFERS:
            replies = [check for check in result.replies if check.same is False]
            assert misread or replies
        if result.verdict in SETTLED and len(paper) > len(INPUTS):
            # inputs on which nothing depends cannot be told; every result can
            results_of = {check.name: check.recomputed for check in result.fields}
            assert all(results_of[name] == paper[name] for name in paper if name not in INPUTS)


def test_most_scans_of_the_sample_are_settled() -> None:
    """Of the genuine ones that were read at all; the others are kept for what must not be said."""
    verdicts = []
    for page in KEPT:
        if page["altered"]:
            continue
        try:
            verdicts += [result.verdict in SETTLED for result in judged(page["read"])]
        except UserError:
            verdicts.append(False)
    assert sum(verdicts) >= len(verdicts) // 2


# --- one thing wrong -----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("3.449 (", "3.449 5 ("),
        ("3.449 (", "3.449 38 ("),
        ("57.47 %", "57.47 E+01 %"),
        ("57.47 %", "57.47 38 %"),
        ("57.47 %", "57.47 8"),
        ("57.47 %", "57.47² %"),
        ("3.449 (", "3.449S ("),
        ("3.449 (", "3.449| ("),
        ("3.449 (", "3.449 - ("),
        ("3.449 (", "3.449 ? ("),
        ("3.449 (", "3.449(7 ("),
        ("3.449 (", "3.449/4.449 ("),
        ("3.449 (", "3.449 VAY= 9.999 ("),
        ("3.449 (", "3.4\u033649 ("),
        ("3.449 (", "\u00ad3.449 ("),
        ("3.449 (", "-\n3.449 ("),
        ("3.449 (", "+3.449 ("),
        ("-13.263", "-13.263 OR -14.263"),
        ("-13.263", "-13.263(9)"),
        ("MU= .911", "MU= 0.911"),
        ("MA= 143.5", "MA= 143.50"),
        ("MA= 143.5", "MA= 143.5 6"),
        ("60      -30", "60-30"),
        (".8202\n", ".8202}4\n"),
    ],
)
@pytest.mark.long
def test_nothing_beside_a_number_is_lost(old: str, new: str) -> None:
    assert SAMPLE.count(old) >= 1
    results = judged(SAMPLE.replace(old, new))
    assert all(result.verdict is not Verdict.IDENTICAL for result in results)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("IA=", "lA="),
        ("PA PB TA TB GA", "PA PE TA TE GA"),
        ("VX= 14.52", "VWX= 14.52"),
        ("MU=", "NU="),
        (" %", ""),
        ("INITIAL KE", "INITIAL  KF"),
        ("UX= ", "UX: "),
        ("\n*****\n", "\nKKKKK\n"),
    ],
)
def test_a_damaged_label_costs_nothing(old: str, new: str) -> None:
    result = one(SAMPLE.replace(old, new, 1))
    assert result.verdict in SETTLED
    assert not doubtful(result)


def test_labels_without_their_sign() -> None:
    assert one(SAMPLE.replace("=", "")).verdict in SETTLED
    assert one(SAMPLE.replace("=", ":")).verdict in SETTLED


def test_a_page_number_is_left_over() -> None:
    result = one(SAMPLE.replace("VX= 14.52", "177\n\nVX= 14.52"))
    assert result.verdict is Verdict.IDENTICAL_AS_READ


def test_every_glyph_ends_in_a_number_a_label_or_left_over() -> None:
    text = SAMPLE.replace("XA= -29.04 YA= 0", "XA= -29.04 YA= 0     <- checked 11/88")
    result = one(text)
    assert result.verdict is Verdict.IDENTICAL_AS_READ
    told = {place.read for place in result.left_over if place.bears}
    told |= {doubt.read for check in result.fields for doubt in check.doubts}
    assert "<" in "".join(told)


def test_fragments_and_second_pages_are_told() -> None:
    results = [verify(one) for one in read_printouts(SAMPLE + "\n PAGE 2\n\nMA= 143.5 MB= 95.8\n")]
    assert [result.verdict for result in results] == [Verdict.IDENTICAL, Verdict.INCOMPLETE]
    assert "PAGE 2" in {piece.read for piece in results[0].left_over}


@pytest.mark.long
def test_results_alone_with_the_inputs_apart() -> None:
    (shown,) = read_printouts(SAMPLE[SAMPLE.index("INITIAL") :])
    assert verify(shown).verdict is Verdict.INCOMPLETE
    given = dict(sample(1).items())
    result = verify(shown, given=given)
    assert all(check.same for check in result.fields if check.printed is not None)
    assert verify(shown, given={**given, "MA": "144"}).verdict is Verdict.DIFFERS


# --- what a reader does and what was altered -----------------------------------------------------

NOISE = SAMPLE.replace("*****", "KKKKK").replace("INITIAL", "1NITIAL")


def test_a_digit_that_is_another_is_never_looked_past_alone() -> None:
    """On a page with every mark of a scanner too; but what the page shows twice is its reader's."""
    alone = one(NOISE.replace("-8.78", "-3.78"))
    assert alone.verdict is Verdict.DIFFERS
    assert alone.explanations[0].look == ["line 18, column 30: is this 3 an 8?"]
    twice = one(NOISE.replace("-8.78", "-3.78").replace("-8.09", "-3.09"))
    assert twice.verdict is Verdict.IDENTICAL_AS_READ
    assert [check.name for check in doubtful(twice)] == ["XAF", "XBF"]
    assert (
        one(SAMPLE.replace("-8.78", "-3.78").replace("-8.09", "-3.09")).verdict is Verdict.DIFFERS
    )


@pytest.mark.parametrize(
    ("old", "new"), long_but([("19.982", "19@.982"), ("143.5", "14S3.5"), ("-8.78", "-8.7@8")])
)
def test_a_look_alike_within_a_number_is_a_digit(old: str, new: str) -> None:
    """Not a speck, although the number without it is what the program prints."""
    assert one(SAMPLE.replace(old, new)).verdict is Verdict.DIFFERS
    speck = one(SAMPLE.replace(old, f"{old[:-1]}|{old[-1]}"))
    assert speck.verdict is Verdict.IDENTICAL_AS_READ


def test_a_lost_sign_is_a_readers_only_where_a_reader_was() -> None:
    text = NOISE.replace("WA= -1.745", "WA= 1.745")
    assert one(text).verdict is Verdict.IDENTICAL_AS_READ
    assert one(SAMPLE.replace("WA= -1.745", "WA= 1.745")).verdict is Verdict.DIFFERS


def test_settled_by_its_own_rule() -> None:
    (shown,) = read_printouts(NOISE)
    assert shown.machine_read
    assert not read_printouts(SAMPLE)[0].machine_read
    checks = verify(shown).fields
    assert is_reader_error(checks, [])
    checks[3].status = Status.NOT_READ
    assert not is_reader_error(checks, [])


@pytest.mark.parametrize("elsewhere", long_but(range(4)))
def test_a_letter_for_a_digit_licenses_no_digit_for_a_digit(elsewhere: int) -> None:
    """However often zeros came out as something else: an 8 for a 0 that stands alone differs."""
    text = NOISE.replace("XA= -29.04", "XA= -29.84")
    for old, new in (("WB= 0", "WB= O"), ("YA= 0", "YA= @"), ("UY= 0", "UY= O"))[:elsewhere]:
        text = text.replace(old, new, 1)
    assert one(text).verdict is Verdict.DIFFERS


WORN = {
    "MA= 143.5": "MA= l43.5",
    "IB= 1961": "IB= l961",
    "DA= 7.59": "DA= 7.S9",
    "VX= 14.52": "VX= l4.52",
    "EM= -.715": "EM= ~.715",
    "KE= 100904": "KE= l00904",
    "57.47": "S7.47",
}
"""Numbers in which a glyph was read for another; a fifth of a page's."""


def test_a_lone_digit_differs_on_a_badly_read_page_too() -> None:
    text = NOISE
    for old, new in WORN.items():
        assert old in text
        text = text.replace(old, new, 1)
    assert one(text).verdict in SETTLED
    assert one(text.replace("-8.78", "-3.78")).verdict is Verdict.DIFFERS


PROMPTS = run(sample(1)).page.replace("*****", "KKKKK").replace("INITIAL KE", "1NITIAL KE")


@pytest.mark.long
def test_a_digit_misread_in_a_reply_counts_like_any_other() -> None:
    """A zero with a stroke through it: read as 8 in the reply and in a number, and with a comma
    run into it; the prompt's own mark is none of the reply's."""
    assert one(PROMPTS).verdict in SETTLED
    text = PROMPTS.replace("XA= -29.04", "XA= -29.84", 1)
    assert one(text).verdict is Verdict.DIFFERS
    for old, new in (("?-29.04", "7-29.84"), (",25.15,0", ",25.15,68")):
        assert old in text
        assert one(text.replace(old, new, 1)).verdict is Verdict.IDENTICAL_AS_READ
    told = [check for check in one(text.replace("?-29.04", "7-29.84", 1)).replies if check.doubts]
    assert [(one.read, one.printed) for check in told for one in check.doubts][-1] == ("8", "0")


# --- margins -------------------------------------------------------------------------------------


def cropped(text: str, start: int | None = None, stop: int | None = None) -> str:
    """A text of which a margin is cut off."""
    return "\n".join(line[start:stop] for line in text.split("\n"))


@pytest.mark.long
def test_digits_lost_at_no_edge_are_another_number() -> None:
    text = run(sample(1)).page.replace(ROW, ROW.lstrip()[2:])
    assert one(text).verdict is Verdict.DIFFERS
    two = text.replace("MA= 143.5", "= 143.5").replace("DA= 7.59", "= 7.59")
    assert one(two).verdict is Verdict.DIFFERS
    other = run(sample(1)).page.replace(ROW, ROW.lstrip().replace("-19.8", "-17.8"))
    assert one(cropped(other, 2)).verdict not in SETTLED


def test_an_exponent_is_no_label() -> None:
    (shown,) = read_printouts(SAMPLE.replace("E= 5E-03", "5E-03"))
    assert shown.text("E") == "5E-03"


@pytest.mark.long
def test_decimals_lost_behind_their_point_are_a_readers_only_where_a_reader_was() -> None:
    """FORTRAN ends whole numbers so, and a person copies what it printed."""
    for text, settles in ((NOISE, True), (SAMPLE, False)):
        assert (one(text.replace("YA= 15.91", "YA= 15.")).verdict in SETTLED) is settles


def test_a_dash_within_figures_is_a_point() -> None:
    result = one(SAMPLE.replace("DA= 7.59", "DA= 7-59"))
    assert result.verdict is Verdict.IDENTICAL_AS_READ
    assert [doubt.printed for doubt in doubtful(result)[0].doubts] == ["."]
    assert one(SAMPLE.replace("DA= 7.59", "DA= 7-69")).verdict is Verdict.DIFFERS


@pytest.mark.usefixtures("whole")
@pytest.mark.parametrize(("number", "is_told"), [(1, False), (2, True)])
def test_what_a_page_cannot_verify_is_the_first_thing_said(number: int, is_told: bool) -> None:
    """With M = 4 that is a third of the inputs: one misread there leaves the page identical."""
    result = one(run(sample(number)).printout)
    assert result.verdict is Verdict.IDENTICAL
    told = "not verifiable on this page: IA, IB, PA, PB, TA, TB, EM"
    assert (summary(result)[0] == told) is is_told


def test_a_digit_added_behind_a_blank_is_named() -> None:
    """Where nothing else differs; no other explanation fits it."""
    result = one(SAMPLE.replace("-13.263", "-13.263 5"))
    assert result.verdict is Verdict.DIFFERS
    assert sections(result)[EXPLAINED] == ["a digit 5 stands after VAX -13.263, behind a blank"]
    other = one(SAMPLE.replace("-13.263", "-13.268 5"))
    assert "behind a blank" not in " ".join(sections(other).get(EXPLAINED, []))


def test_a_page_whose_margin_is_cut_off_is_incomplete() -> None:
    """With it goes the first angle: it is not read, and the page incomplete."""
    row = ROW.strip()
    lost = row.split(None, 1)[1]
    text = SAMPLE.replace(row, lost)
    assert one(text).verdict is Verdict.INCOMPLETE
    cut = "\n".join(line[2:] if "=" in line else line for line in text.split("\n"))
    result = one(cut)
    assert result.verdict is Verdict.INCOMPLETE
    assert any("margin is cut off" in remark for remark in result.remarks)


@pytest.mark.long
def test_a_mark_for_the_illegible_may_stand_for_a_whole_number() -> None:
    """It was never read: nothing that hangs on it contradicts the page."""
    result = one(SAMPLE.replace("UX= -29.04", "UX= ?"))
    assert result.verdict is Verdict.INCOMPLETE
    assert result.missing == ["UX"]
    (shown,) = read_printouts(SAMPLE.replace("UX= -29.04", "UX= ?"))
    assert verify(shown, given={"UX": "-39.04"}).verdict is Verdict.DIFFERS


def test_blanks_inside_numbers_are_a_readers() -> None:
    text = SAMPLE.replace("14.52", "14. 52").replace("25.15", "25. 15")
    assert not read_printouts(text)[0].machine_read
    assert read_printouts(text.replace("57.47", "57. 47"))[0].machine_read


@pytest.mark.parametrize("row", long_but(["~19.8 -38,7 O) 60 -30 |", "-19.8-38.7 0 60-30"]))
def test_a_damaged_row_of_angles_is_cut_where_it_reads_best(row: str) -> None:
    result = one(NOISE.replace(ROW, row))
    assert result.verdict is Verdict.IDENTICAL_AS_READ
    assert numbers(result) == sample(1).numbers()
    altered = NOISE.replace(ROW, row.replace("60", "50"))
    assert one(altered).verdict not in SETTLED


def test_a_row_of_angles_that_no_reading_explains_is_missing() -> None:
    """It was read uncertainly: what hangs on it accuses nobody."""
    result = one(NOISE.replace(ROW, " -19.8 -33.7 0 60-30"))
    assert result.verdict is Verdict.INCOMPLETE
    assert result.missing == ["PA", "PB", "TA", "TB", "GA"]


@pytest.mark.parametrize(
    ("old", "new", "left"), [("YA= 15.91)", "YA= 15.91) 99.99", "99.99"), ("KKKKK", "6KKKK", "6")]
)
def test_figures_beside_what_ends_a_line_are_left_over(old: str, new: str, left: str) -> None:
    """Behind the bracket that ends its number, and in place of an asterisk."""
    assert old in NOISE
    result = one(NOISE.replace(old, new, 1))
    assert result.verdict is Verdict.IDENTICAL_AS_READ
    assert [piece.read for piece in result.left_over] == [left]


# --- inputs that were lost or misread ------------------------------------------------------------


def numbers(result: Verification) -> dict[str, float]:
    """The recovered scene as numbers."""
    return {name: float(text or "nan") for name, text in result.scene.items()}


@pytest.mark.parametrize(
    ("old", "new"),
    long_but(
        [
            ("MA= 143.5", "MA= 148.5"),
            ("IA= 3728", "IA= 8728"),
            ("DB= 3.44", "DB= 3.41"),
            ("-38.7", "-33.7"),
            ("60      -30", "80      -30"),
            ("EM= -.715", "EM= -.716"),
            ("VAY= 3.449", "VAY= 3.440"),
            ("LOSS= 57.47", "LOSS= 51.47"),
        ],
        kept=(0, 7),
    ),
)
def test_an_altered_digit_is_not_solved_away(old: str, new: str) -> None:
    """No other inputs that would make good for it are an explanation, on a page with every mark of
    a scanner either: the scene that asks least decides."""
    assert one(NOISE.replace(old, new)).verdict not in SETTLED


# --- what cannot be shown ------------------------------------------------------------------------


@pytest.mark.usefixtures("whole")
def test_what_a_page_cannot_show() -> None:
    result = one(run(sample(2)).printout)
    assert result.verdict is Verdict.IDENTICAL
    (line, *_) = result.unseen
    for name in ("IA", "IB", "PA", "TB"):
        assert name in line.split(":")[0]
    text = run(sample(2)).printout.replace("IA= 3728", "IA= 9728")
    assert one(text).verdict is Verdict.IDENTICAL  # the program prints just that
    sums = one(SAMPLE).unseen
    assert any("PA and TA" in line for line in sums)


@pytest.mark.usefixtures("whole")
def test_digits_too_small_to_show_are_told_and_no_others() -> None:
    """Against runs of the program one by one: a mass of 1.6 against one of 260542."""
    (page,) = (page for page in scans() if page["name"] == "1-018")
    (text,) = page["printed"]
    result = one(text)
    told = result.unseen[-1]
    assert "IB 64(44291)" in told
    scene = {name: value or "" for name, value in result.scene.items()}
    replied = {check.name for check in result.replies}
    assert "UY" in replied  # where another digit would not be the reply
    paper = outcome_fields(text)
    for name in ("MB", "IB", "DA", "UY"):
        marked = next((word for word in told.split(", ") if word.startswith(f"{name} ")), "")
        faint = set()
        for place, old in enumerate(paper[name]):
            for new in set("0123456789") - {old} if old.isdigit() else ():
                other = paper[name][:place] + new + paper[name][place + 1 :]
                fields = outcome_fields(run({**scene, name: other}).printout)
                same = {**fields, name: ""} == {**paper, name: ""} and name not in replied
                if printable(other) and same:
                    faint.add(place)
        digits = "".join(f"({c})" if at in faint else c for at, c in enumerate(paper[name]))
        assert marked == (f"{name} {digits.replace(')(', '')}" if faint else "")
    assert not any("brackets" in line for line in one(SAMPLE).unseen)


# --- what people paste, and what is hostile ------------------------------------------------------


@pytest.mark.parametrize(
    "change",
    [
        lambda text: text.encode("cp1252"),
        lambda text: text.replace("-", "–").encode("cp1252"),
        lambda text: text.replace("-", "–").encode("mac_roman"),
        lambda text: bytes(byte | 0x80 for byte in text.replace("\n", "\r").encode()),
        lambda text: ("<pre>" + text.replace("-", "&minus;") + "</pre>").encode(),
        lambda text: "".join(f"> {line}\n" for line in text.split("\n")).encode(),
        lambda text: ("```\n" + text + "```\n").encode(),
    ],
)
def test_what_people_save_and_paste(change: Any) -> None:
    (shown,) = printouts.from_bytes(change(SAMPLE), "page")
    assert verify(shown).verdict in SETTLED


@pytest.mark.parametrize(
    ("start", "says"),
    [
        (b"%PDF-1.4", "is a PDF; expected text"),
        (b"\x89PNG\r\n", "is a PNG picture; expected text"),
        (b"PK\x03\x04", "is a packed file.*expected text: save it as plain text"),
    ],
)
def test_files_that_are_no_text_say_what_they_are(start: bytes, says: str) -> None:
    with pytest.raises(UserError, match=says):
        printouts.from_bytes(start + b"\0" * 200, "page")


ROW = " -19.8      -38.7      0      60      -30"


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (ROW, "O" * 80),
        pytest.param(ROW, "l " * 80, marks=SLOW),
        pytest.param(ROW, "1" * 30, marks=pytest.mark.long),
        pytest.param(ROW, "1" * 80, marks=pytest.mark.long),
        pytest.param(ROW, "?" * 80, marks=SLOW),
        pytest.param("143.5", "1" * 30, marks=pytest.mark.long),
        pytest.param("143.5", "1" * 300, marks=SLOW),
        pytest.param("143.5", "1E67", marks=SLOW),
        pytest.param("143.5", "9.99999E99", marks=SLOW),
        ("-13.263", "1E-67"),
        ("143.5", "1?" * 200),
        pytest.param("143.5", "0", marks=pytest.mark.long),
    ],
)
def test_hostile_text_gets_a_verdict(old: str, new: str) -> None:
    for result in judged(SAMPLE.replace(old, new)):
        assert result.verdict not in SETTLED


@pytest.mark.long
def test_labels_without_end_are_read_in_windows() -> None:
    with pytest.raises(UserError, match="no printout"):
        read_printouts("MA= " * 4000)


def many() -> list[Printout]:
    return read_printouts("\n".join([SAMPLE] * 20))


def test_windows_lose_no_printout() -> None:
    assert [len(shown.fields) for shown in many()] == [36] * 20


def test_a_badly_read_page_is_neither_settled_nor_accused() -> None:
    """A digit that stands alone differs on a page of few marks, and is open on one of many."""
    text = NOISE.replace("-8.78", "-3.78")
    assert one(text).verdict is Verdict.DIFFERS
    worn = text.replace("KKKKK", "HHEHH").replace("VAX", "UAK").replace("VBX", "UBK")
    worn = worn.replace("UX", "UK").replace("MA=", "NA=").replace("MB=", "NB=")
    assert one(worn.replace("XA=", "KA=").replace("XB=", "KB=")).verdict is Verdict.INCOMPLETE


@pytest.mark.long
def test_more_than_two_alterations_on_a_machine_read_page_are_its_readers() -> None:
    """They are told, and the page is not settled; what a person typed differs."""
    wrong = {
        "MA= 143.5": "MA= 148.5",
        "IB= 1961": "IB= 7961",
        "-38.7": "-33.7",
        "EM= -.7": "EM= -.1",
    }
    typed, read = SAMPLE, NOISE
    for old, new in wrong.items():
        typed, read = typed.replace(old, new), read.replace(old, new)
    assert one(typed).verdict is Verdict.DIFFERS
    result = one(read)
    assert result.verdict is Verdict.INCOMPLETE
    assert any("numbers are read otherwise" in remark for remark in result.remarks)


@pytest.mark.parametrize(("altered", "expected"), long_but([(2, "differs"), (3, "incomplete")]))
def test_two_alterations_on_a_machine_read_page_accuse_and_three_do_not(
    altered: int, expected: str
) -> None:
    """Each alone is a digit for a digit, which an alteration or a reader may have made."""
    wrong = [("57.47", "51.47"), ("-13.263", "-18.263"), ("19.982", "14.982")]
    text = NOISE
    for old, new in wrong[:altered]:
        assert old in text
        text = text.replace(old, new)
    result = one(text)
    assert str(result.verdict) == expected
    assert len(result.differing) == altered


@pytest.mark.long
def test_reading_ends_where_there_is_too_much_text(monkeypatch: pytest.MonkeyPatch) -> None:
    """Told with the place, and never settled; without a page before it, the file is refused."""
    least = 6000
    monkeypatch.setattr(printout, "Budget", partial(alignment.Budget, left=least))
    monkeypatch.setattr(alignment.Budget, "left", least)
    assert least < alignment.WINDOW  # one window is read, and the next is not
    junk = "VAX VBX MA= " * 1500
    with pytest.raises(UserError, match="was not read"):
        read_printouts("VAX= 1.2 " * 1700)
    result = verify(read_printouts(f"{SAMPLE}\n{junk}")[0])
    assert result.verdict is not Verdict.IDENTICAL
    prose = "the quick brown fox jumps over the lazy dog\n" * 900
    assert one(prose + SAMPLE).verdict is Verdict.IDENTICAL


def test_a_reader_that_reads_all_else_loses_no_mark() -> None:
    """A mark that is told, then, is hardly the reader's; asterisks are."""
    exact = without_asterisks = 0
    for row in (row for row in scans() if row["name"].startswith("2-")):  # the clean pages
        found: list[Printout] = []
        with suppress(UserError):  # some are read so badly that there is no printout in them
            found = read_printouts(row["read"])
        for shown in found:
            numbers = [field.clean for field in shown.fields.values()]
            beside = [piece for piece in shown.left_over if piece.bears]
            labels = [label for label in shown.labels if label.bears and not label.is_mark]
            if len(numbers) == 36 and all(numbers) and not (shown.remarks or beside or labels):
                exact += 1
                without_asterisks += any("asterisks" in note for note in shown.notes)
                assert not any(label.bears for label in shown.labels), row["name"]
    assert (exact, without_asterisks) == (4, 1)
