"""Verdicts on printouts, through the public names."""

from __future__ import annotations

import json
import random
import re
from collections.abc import Callable
from pathlib import Path

import captures
import pytest
from captures import ROOT
from hypothesis import given, settings
from hypothesis import strategies as st

import impact88
from impact88.errors import UserError
from impact88.printouts import VERDICTS, Kind, Verdict, Verification, judge, verify, words
from impact88.printouts.explain import FLOAT32
from impact88.printouts.words import SENTENCES, verdict_table
from impact88.program.copies import ListingCopy
from impact88.program.run import run

PAGE = impact88.run(impact88.sample(1)).page
BODY = PAGE[PAGE.index("MA=") :]
PAIR = re.compile(r"\(?(?:INITIAL KE|KE LOSS|[A-Z]+)= ?-?[0-9.]+(?:E[-+]\d\d)?\)?(?: %)?")
LISTING = (ROOT / "legacy" / "impact.bas").read_text(encoding="utf-8")


def single(text: str) -> Verification:
    (verification,) = judge(text)
    return verification


def kinds(text: str) -> set[Kind]:
    return {finding.kind for finding in single(text).findings}


def with_row(start: str, *rows: str) -> str:
    lines = PAGE.split("\n")
    at = next(k for k, line in enumerate(lines) if line.strip().startswith(start))
    return "\n".join([*lines[:at], *rows, *lines[at + 1 :]])


def row(start: str) -> str:
    return next(line for line in PAGE.split("\n") if line.strip().startswith(start))


# --- what the real machine printed ----------------------------------------------------------------


@pytest.mark.captures
def test_captures_are_identical_as_printed_and_on_an_apples_screen() -> None:
    rows = [item for item in captures.scenes() if "MA= " in item["printout"]]
    errors = [item for item in rows if "ERROR" in item["printout"]]
    for item in random.Random(1).sample(rows, 20) + errors[:2]:
        lines = item["printout"].split("\n")
        screen = [line[k : k + 40] for line in lines for k in range(0, max(1, len(line)), 40)]
        for text in (item["printout"], "\n".join(screen)):
            assert single(text).verdict is Verdict.IDENTICAL, text


@pytest.mark.captures
def test_a_page_that_ends_before_its_first_number_is_incomplete() -> None:
    rows = [item for item in captures.scenes() if "MA= " not in item["printout"]]
    for item in rows[:10]:
        assert single(item["printout"]).verdict is Verdict.INCOMPLETE


# --- layouts of genuine pages ---------------------------------------------------------------------

LAYOUTS: dict[str, Callable[[str], str | bytes]] = {
    "quoted": lambda page: "\n".join("> " + line for line in page.split("\n")),
    "numbered": lambda page: "\n".join(f"{k}: {x}" for k, x in enumerate(page.split("\n"), 1)),
    "stamped": lambda page: "\n".join(
        f"[14:{k // 60:02}:{k % 60:02}] {x}" for k, x in enumerate(page.split("\n"))
    ),
    "small letters": str.lower,
    "CRLF": lambda page: page.replace("\n", "\r\n"),
    "page break": lambda page: page.replace("VX=", "\fVX="),
    "dashes": lambda page: page.replace("-", "−"),
    "no blank lines": lambda page: re.sub(r"\n\n+", "\n", page),
    "without prompts": lambda page: page[page.index("MA=") :],
    "without asterisks": lambda page: page.replace("*****", ""),
    "in a letter": lambda page: f"Dear Sir,\nthis is run 7:\n\n{page}\n\nYours\n",
    "UTF-16": lambda page: page.encode("utf-16"),
    "Windows": lambda page: page.replace("-", "–").encode("cp1252"),
    "EBCDIC": lambda page: page.encode("cp037"),
    "high bit": lambda page: bytes(code | 0x80 for code in page.encode("ascii")),
    "ten decimals": lambda page: impact88.run({**impact88.sample(1), "VX": "-.09421"}).page,
    "printer slot": lambda page: page.replace("MA= 1", "\x04PR# 1\nMA= 1", 1),
}


@pytest.mark.parametrize("name", LAYOUTS)
def test_layouts_of_genuine_pages_are_identical(name: str) -> None:
    text = LAYOUTS[name](PAGE)
    (verification,) = verify(text if isinstance(text, bytes) else text.encode())
    assert verification.verdict is Verdict.IDENTICAL, verification.findings


@pytest.mark.parametrize("name", ["quoted", "numbered", "stamped"])
def test_an_altered_page_with_text_before_its_lines_differs(name: str) -> None:
    (verification,) = verify(str(LAYOUTS[name](PAGE.replace("-13.263", "-13.963"))))
    assert verification.verdict is Verdict.DIFFERS


@pytest.mark.parametrize(
    "text",
    [
        PAGE.replace("VX=", "MAY 11 88 14:22 BROWN & PARTNERS P.03\nVX=", 1),
        BODY.replace(".", ","),
        PAGE.replace(" .911", " 0.911"),
        PAGE.replace("XA= -29.04", "XA= ~29.04"),
        PAGE.replace("MU=", "NU="),
        with_row("DA=", row("DA="), row("DA=")),
    ],
    ids=["fax line", "decimal commas", "zero", "misread sign", "misread label", "row twice"],
)
def test_what_is_not_exact_is_listed(text: str) -> None:
    verification = single(text)
    assert verification.verdict is Verdict.AS_READ
    assert verification.findings


# --- alterations ----------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["MA", "IB", "GA", "UX", "EM", "YB", "KI", "LOSS", "VBY", "WAF"])
def test_one_altered_digit_differs_and_is_named_alone(name: str) -> None:
    number = single(PAGE).numbers[name]
    at = number.start + max(k for k, char in enumerate(number.read) if char.isdigit())
    altered = PAGE[:at] + str((int(PAGE[at]) + 4) % 10) + PAGE[at + 1 :]
    verification = single(altered)
    assert verification.verdict is Verdict.DIFFERS
    (finding,) = verification.findings
    assert (finding.kind, finding.name, finding.printed) == (Kind.NUMBER, name, number.read)
    assert finding.start <= at < finding.stop
    assert verification.explanation.count(finding.read) == 1


SAMPLES = {k: impact88.run(impact88.sample(k)).page for k in (1, 2, 3)}


@pytest.mark.parametrize(
    ("number", "old", "new"),
    [
        (1, "DA= 7.59", "DA= 9.65"),
        (2, "MB= 95.8", "MB= 98.5"),
        (2, "DB= 0", "DB= 1"),  # two results differ
        (2, "MA= 143.5", "MA= 455.1"),
        (3, "EM= -.9", "EM= -.2"),
        (1, "VY= 25.15", "VY= 20.00"),
        (1, "IB= 1961", "IB= -1961"),
    ],
)
def test_an_input_that_explains_everything_is_named_alone(number: int, old: str, new: str) -> None:
    assert old in SAMPLES[number]
    verification = single(SAMPLES[number].replace(old, new))
    assert verification.verdict is Verdict.DIFFERS
    (finding,) = verification.findings
    assert f"{finding.name}= {finding.printed}" == old
    assert f"{finding.name} {finding.read} is a slip" in verification.explanation


def test_inputs_read_cleanly_are_the_scene_where_no_single_one_explains_the_results() -> None:
    text = BODY.replace("DA= 7.59", "DA= 9.65").replace("IA= 3728", "IA= 3278")
    verification = single(text)
    assert verification.verdict is Verdict.DIFFERS
    assert verification.scene["DA"] == "9.65"
    assert {finding.name for finding in verification.findings} <= {*verification.numbers} - {
        *impact88.sample(1)
    }
    assert verification.explanation.startswith("the numbers listed were not computed")
    one = single(text.replace("IA= 3278", "IA= 3728"))
    assert one.scene["DA"] == "7.59"


def test_a_single_result_that_differs_blames_no_input() -> None:
    for text, name in (
        (BODY.replace("-.8202", "-.8203"), "WBF"),
        (BODY.replace("57.", "58."), "LOSS"),
    ):
        assert [finding.name for finding in single(text).findings] == [name]


@pytest.mark.parametrize(
    ("number", "old", "new", "pair"),
    [
        (1, " 60 ", " 56 ", {"PB": "-34.7", "TB": "60"}),
        (1, "-38.7 ", "-38.1 ", {"PB": "-38.7", "TB": "59.4"}),
        (3, " 90 ", " 93 ", {"PB": "-43", "TB": "90"}),
        (3, " 90 ", " -90 ", {"PB": "140", "TB": "90", "DB": "-4"}),
    ],
)
def test_angles_that_enter_as_a_sum_are_both_named(
    number: int, old: str, new: str, pair: dict[str, str]
) -> None:
    verification = single(SAMPLES[number].replace(old, new))
    assert verification.verdict is Verdict.DIFFERS
    assert {f.name: f.printed for f in verification.findings} == pair
    assert {finding.kind for finding in verification.findings} == {Kind.EITHER}
    for name, printed in pair.items():
        assert f"{name} {verification.numbers[name].read} (would be {printed})" in (
            verification.explanation
        )


def test_an_angle_is_open_if_the_other_of_its_sum_was_read_with_doubt() -> None:
    page = impact88.run({**impact88.sample(1), "TB": "29", "PB": "-32"}).page
    assert single(page.replace(" 29 ", " 29*1) ")).verdict is Verdict.INCOMPLETE
    assert single(page.replace(" -32 ", " -33 ")).verdict is Verdict.DIFFERS


@pytest.mark.parametrize("number", [1, 2, 3])
def test_lost_numbers_never_differ_and_never_are_identical(number: int) -> None:
    page = impact88.run(impact88.sample(number)).page
    spans = [match.span() for match in PAIR.finditer(page) if match.start() >= page.index("MA=")]
    for count in (1, 2, 3):
        for k in range(0, len(spans) - count + 1, 3):
            text = page[: spans[k][0]] + page[spans[k + count - 1][1] :]
            for verification in judge(text):
                assert verification.verdict in (Verdict.INCOMPLETE, Verdict.AS_READ), text


@pytest.mark.parametrize("width", [1, 2, 3, 4, 5, 6])
def test_lost_characters_accuse_only_the_number_that_lost_them(width: int) -> None:
    numbers = single(BODY).numbers.values()
    for at in range(width, len(BODY) - width, 47):
        is_in_number = any(number.start <= at + width and at <= number.stop for number in numbers)
        for verification in judge(BODY[:at] + BODY[at + width :]):
            assert is_in_number or verification.verdict is not Verdict.DIFFERS, at


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (" E= 5E-03", " E-03"),
        (" E= 5E-03", " E= -03"),
        ("XB= 14.51 YB=", "XB= 14"),
        ("VAY= 3.449 (", "VAY= 3("),
        ("GA\n -19.8", "19.8"),
        ("KE LOSS=", "KE="),
        ("VBX=", "V="),
        ("-03 MU=", "="),
        ("WB= 0 XB= 14.51", "WB= 014.51"),
    ],
)
def test_what_was_not_read_in_one_piece_accuses_nothing(old: str, new: str) -> None:
    assert old in BODY
    verification = single(BODY.replace(old, new, 1))
    assert verification.verdict in (Verdict.INCOMPLETE, Verdict.AS_READ)


@pytest.mark.parametrize("name", ["MA", "E", "LOSS", "VAY", "YBF", "WBF"])
def test_a_stray_digit_behind_a_number_never_passes(name: str) -> None:
    stop = single(PAGE).numbers[name].stop
    verification = single(PAGE[:stop] + " 5" + PAGE[stop:])
    assert verification.verdict in (Verdict.INCOMPLETE, Verdict.DIFFERS)


@pytest.mark.parametrize("old", ["IB= 1961", "DB= 3.44", "-30", "EM= -.715"])
def test_a_number_cut_at_the_end_of_its_row_is_open_and_another_differs(old: str) -> None:
    digit = max(k for k, char in enumerate(old) if char.isdigit())
    for end in range(digit, digit - 2, -1):
        if old[end - 1].isdigit():
            assert single(PAGE.replace(old + "\n", old[:end] + "\n")).verdict is Verdict.INCOMPLETE
    first = re.sub(r"^(\D*[0-9]).*", r"\1", old)  # all but the first digit
    assert single(PAGE.replace(old + "\n", first + "\n")).verdict is Verdict.INCOMPLETE
    other = old[: digit - 1] + "8" + old[digit:]
    assert single(PAGE.replace(old + "\n", other + "\n")).verdict is Verdict.DIFFERS


@pytest.mark.parametrize(
    ("old", "new", "read"),
    [
        ("INITIAL KE", "FINAL KE", "FINAL"),
        ("INITIAL KE", "TOTAL KE", "TOTAL"),
        ("%", "ft", "ft"),
        ("LOSS", "GAIN", "GAIN"),
    ],
)
def test_another_word_differs_where_all_else_is_read_exactly(old: str, new: str, read: str) -> None:
    text = PAGE.replace(old, new)
    verification = single(text)
    assert verification.verdict is Verdict.DIFFERS
    (finding,) = [f for f in verification.findings if f.kind is Kind.LABEL]
    assert finding.read == read
    assert f"{read!r} where the program prints {old.split()[0]!r}" in "\n".join(
        words.write(verification)
    )
    assert single(text.replace("DA=", "0A=")).verdict is Verdict.AS_READ


def test_a_word_that_the_apple_cannot_print_is_a_doubt() -> None:
    for word, verdict in (("FX", Verdict.DIFFERS), ("µ", Verdict.AS_READ), ("ΜЦ", Verdict.AS_READ)):
        verification = single(PAGE.replace("MU=", f"{word}="))
        assert verification.verdict is verdict
        assert word.upper() in {finding.read.upper() for finding in verification.findings}


@pytest.mark.parametrize("word", ["INITAL", "INITXAL", "INITLAL", "lNlTlAL", "NITIAL"])
def test_a_misprinted_label_is_listed_by_word(word: str) -> None:
    verification = single(PAGE.replace("INITIAL KE", f"{word} KE"))
    assert verification.verdict is Verdict.AS_READ
    assert [(f.kind, f.read) for f in verification.findings] == [(Kind.MISREAD, word)]


def test_numbers_that_run_into_a_word_are_the_pages_own() -> None:
    for text in (re.sub(r"-\.715\s*INITIAL", "-.715INITIAL", PAGE), PAGE.replace("\n", "")):
        verification = single(text)
        assert verification.verdict is Verdict.IDENTICAL
        assert verification.scene["EM"] == "-.715"


def test_summaries_say_what_is_not_there() -> None:
    def summary(text: str) -> str:
        return words.write(single(text), brief=True)[1]

    assert "all else from the first row" in summary(PAGE)
    assert "everything else is what the program prints" in summary(with_row("UX="))
    assert "everything else" not in summary(with_row("UX=").replace("DA=", "0A="))
    assert "--scene" in summary(BODY[BODY.index("INITIAL") :])


def test_digits_that_nothing_confirms() -> None:
    page = SAMPLES[2]  # M = 4 without arms
    verification = single(page)
    for name, other in (("IA", "9999"), ("PA", "-11.1")):
        read = verification.numbers[name].read
        assert verification.unseen[name] == sum(map(str.isdigit, read))
        assert single(page.replace(f" {read} ", f" {other} ", 1)).verdict is Verdict.IDENTICAL
    assert not {"MA", "MB", "UX"} & verification.unseen.keys()


def test_a_lost_angle_is_missing() -> None:
    angles = row("-19.8").split()
    for k in range(5):
        text = with_row("-19.8", "  ".join(angles[:k] + angles[k + 1 :]))
        assert single(text).verdict is Verdict.INCOMPLETE


@pytest.mark.parametrize("start", ["MA=", "DA=", "UX=", "E=", "VAX=", "WA="])
def test_a_row_lost_or_twice_is_named(start: str) -> None:
    lost = single(with_row(start))
    assert any(f.kind is Kind.ROW_LOST and start[:-1] in f.name for f in lost.findings)
    assert lost.verdict is Verdict.INCOMPLETE
    twice = single(with_row(start, row(start), row(start)))
    assert twice.verdict is Verdict.AS_READ
    assert [f.kind for f in twice.findings] == [Kind.ROW_TWICE]
    other = re.sub(r"[1-8](?!.*[1-8])", "9", row(start))
    assert single(with_row(start, row(start), other)).verdict is Verdict.DIFFERS


def test_rows_of_another_printout_accuse_nothing() -> None:
    other = SAMPLES[3]
    assert single(BODY + other[other.index("VAX=") :]).verdict is Verdict.INCOMPLETE


def test_another_number_behind_a_damaged_label_is_not_a_doubt() -> None:
    text = BODY.replace("DA=", "0A=").replace("LOSS", "L0SS").replace("UX=", "UK=")
    assert single(text.replace("MA= 143.5", "NN- 143.5")).verdict is Verdict.AS_READ
    assert single(text.replace("MA= 143.5", "NN- 193.5")).verdict is Verdict.INCOMPLETE


def test_a_prompt_without_its_reply_is_not_identical() -> None:
    (finding,) = single(PAGE.replace("?14.52,25.15,0", "?")).findings
    assert (finding.kind, finding.name) == (Kind.LOST, "REPLY_B")


@pytest.mark.parametrize(
    ("start", "note", "verdict"),
    [
        ("DA=", "  UX= 41 mph", Verdict.AS_READ),
        ("VAX=", "  (WA= 0)", Verdict.AS_READ),
        ("DA=", "  DB= 41", Verdict.AS_READ),
        ("DA=", "\nDB= 41", Verdict.AS_READ),
        ("UX=", "\nYA= 41 mph", Verdict.AS_READ),
        ("WA=", "\n  WB= 41", Verdict.AS_READ),
        ("DA=", "\nUX= 41 UY= 0 WA= 0 XA= 41 YA= 0", Verdict.DIFFERS),
    ],
)
def test_a_label_beside_another_row_is_a_note(start: str, note: str, verdict: Verdict) -> None:
    verification = single(with_row(start, row(start) + note))
    assert verification.verdict is verdict
    if verdict is Verdict.AS_READ:
        assert verification.numbers["UX"].read == "-29.04"


def test_of_a_label_twice_in_a_row_neither_accuses() -> None:
    for name, number in single(PAGE).numbers.items():
        if f" {name}= {number.read} " in PAGE:
            for pair in (f"{{0}}= 41 {{0}}= {number.read}", f"{{0}}= {number.read} {{0}}= 41"):
                text = PAGE.replace(f" {name}= {number.read}", " " + pair.format(name), 1)
                assert single(text).verdict in (Verdict.AS_READ, Verdict.INCOMPLETE), text


@pytest.mark.parametrize("title", ["Case 88-1432", "RUN 1", "12", "IA= 2215 IB= 3000"])
def test_a_line_above_the_page_changes_nothing(title: str) -> None:
    altered = BODY.replace(" 0      60      -30", " 2      60      -30")
    one = single(altered).explanation.partition(":")[2]
    assert " or TA 2 " in one
    verification = single(f"{title}\n\n{altered}")
    assert verification.verdict is Verdict.DIFFERS
    assert verification.explanation.partition(":")[2] == one
    assert single(f"{title}\n\n{BODY}").verdict in (Verdict.IDENTICAL, Verdict.AS_READ)


@pytest.mark.parametrize("note", [" 12", "     12", "\n12", "\n\n 1991"])
def test_a_number_beside_a_reply_is_not_the_replys(note: str) -> None:
    reply = "?-29.04,0,0"
    assert reply in PAGE
    assert single(PAGE.replace(reply, reply + note)).verdict is Verdict.AS_READ
    torn = PAGE.replace(reply, "?- 9.04,0,0")
    assert single(torn).verdict is Verdict.AS_READ
    assert single(PAGE.replace("?14.52,25.15", "? 4.52,25.15")).verdict is Verdict.INCOMPLETE
    altered = PAGE.replace(reply, "?-29.04,1,0")
    assert single(altered).verdict is Verdict.DIFFERS


@pytest.mark.parametrize(
    ("old", "new", "verdict"),
    [
        ("MA= 143.5", "MA= 143.5(1)", Verdict.INCOMPLETE),
        ("MA= 143.5", "MA= 143.6", Verdict.DIFFERS),
        ("VAX= -13.263", "VAX= 1) -13.263", Verdict.INCOMPLETE),
        ("VAX= -13.263", "VAX= -13.264", Verdict.DIFFERS),
        ("VAY= 3.449", "VAY= 3.4 [torn]", Verdict.INCOMPLETE),
        ("IA= 3728 IB= 1961", "IA= 3728 IB= 19]]", Verdict.INCOMPLETE),
    ],
)
def test_marks_at_a_number_accuse_nothing(old: str, new: str, verdict: Verdict) -> None:
    assert single(PAGE.replace(old, new)).verdict is verdict


def test_rows_of_another_printout_are_not_explained_by_an_arithmetic() -> None:
    other = SAMPLES[3][SAMPLES[3].index("VBX=") :]
    assert "precision" not in single(PAGE.rstrip() + "\n" + other).explanation


def test_numbers_without_labels_are_no_spins() -> None:
    for note, verdict, m in (
        ("1.47 x 24.9", Verdict.AS_READ, "4"),
        ("x", Verdict.AS_READ, "4"),
        ("W 12 B 13", Verdict.AS_READ, "4"),
        ("\nWA= 1.47 WB= 24.9", Verdict.DIFFERS, "6"),
    ):
        verification = single(SAMPLES[2].replace("20.77)", f"20.77)  {note}"))
        assert note in verification.text
        assert (verification.verdict, verification.scene["M"]) == (verdict, m)


@pytest.mark.parametrize(
    ("old", "new", "verdict"),
    [
        ("100904.929", "1009    29", Verdict.INCOMPLETE),
        ("MA= 143.5", "MA= 1   .5", Verdict.INCOMPLETE),
        ("100904.929", "1009", Verdict.DIFFERS),
        ("VAX= -13.263", "VAX=     263", Verdict.INCOMPLETE),
        ("VAX= -13.263", "VAX= 263", Verdict.DIFFERS),
        ("IB= 1961", "IB= [sic] 1961", Verdict.AS_READ),
        ("IB= 1961", "IB= [sic] 1962", Verdict.DIFFERS),
    ],
)
def test_a_number_with_a_hole_is_open(old: str, new: str, verdict: Verdict) -> None:
    assert single(PAGE.replace(old, new)).verdict is verdict


@pytest.mark.parametrize(
    ("part", "step"),
    [(slice(0, 1), 1), (slice(-1, None), 1), (slice(0, 2), 3), (slice(-2, None), 3)],
)
def test_lost_characters_that_leave_blanks_accuse_nothing(part: slice, step: int) -> None:
    """The beginning or the end of a number did not print. How far the first angle is from the
    margin is not known."""
    for name, number in [*single(BODY).numbers.items()][::step]:
        lost = number.printed[part]
        torn = [*number.printed]
        torn[part] = " " * len(lost)
        if "".join(torn).strip() and (name != "PA" or part.start != 0):
            text = BODY[: number.start] + "".join(torn) + BODY[number.stop :]
            assert single(text).verdict is Verdict.INCOMPLETE, (name, torn)


def test_lost_characters_of_two_numbers_accuse_no_third() -> None:
    body = BODY.replace("VAY= 3.449", "VAY=   449")
    for old, new in (("IB= 1961", "IB= 19"), ("DB= 3.44", "DB= 3"), ("5E-03", "    3")):
        assert old in body
        assert single(body.replace(old, new)).verdict is Verdict.INCOMPLETE
        assert single(BODY.replace(old, new.strip())).verdict is not Verdict.IDENTICAL
    elsewhere = body.replace("VAX= -13.263", "VAX= -13.963")
    assert single(elsewhere).verdict is Verdict.DIFFERS


def test_blanks_count_only_where_they_are_wider_than_on_the_rest_of_the_page() -> None:
    wide = PAGE.replace(" ", "   ")
    assert single(wide).verdict is Verdict.IDENTICAL
    for old, new in (("IA=   3728", "IA=   37"), ("-13.263", "13.263"), ("-38.7", "38.7")):
        assert single(wide.replace(old, new)).verdict is Verdict.DIFFERS


def test_a_reply_torn_at_the_margin_is_open() -> None:
    page = impact88.run({**impact88.sample(1), "WB": "-.12"}).page
    assert ",-.12\n" in page
    for reply, verdict in (("-0.", Verdict.INCOMPLETE), ("-.2", Verdict.DIFFERS)):
        assert single(page.replace(",-.12\n", f",{reply}\n")).verdict is verdict


def test_utf_8_is_read_as_utf_8() -> None:
    text = PAGE.replace("MA=", "M\N{CYRILLIC CAPITAL LETTER A}=")
    for encoding in ("utf-8", "utf-16-le"):
        (verification,) = verify(text.encode(encoding))
        assert verification.verdict is Verdict.AS_READ
        assert "M\N{CYRILLIC CAPITAL LETTER A}" in [
            finding.read for finding in verification.findings
        ]


def test_full_width_digits_are_not_the_programs() -> None:
    for old, new in (("3.449", "3.４49"), ("57.47", "５７.４７")):
        assert single(BODY.replace(old, new)).verdict in (Verdict.INCOMPLETE, Verdict.AS_READ)


def test_rows_in_each_others_place_are_named() -> None:
    text = with_row("DA=", row("UX=")).replace(row("UX="), "#", 2)
    text = text.replace("#", row("UX="), 1).replace("#", row("DA="))
    assert Kind.DISORDER in kinds(text)


@pytest.mark.parametrize(
    ("label", "other"),
    [("MB", "MA"), ("IB", "IA"), ("VX", "VAX"), ("YB", "YA"), ("EM", "MU"), ("(XA", "(YB")],
)
def test_another_label_differs(label: str, other: str) -> None:
    text = BODY.replace(f"{label}=", f"{other}=", 1)
    at = text.rfind(f"{other}=", 0, BODY.index(f"{label}="))  # exchanged with the one before it
    swapped = text[:at] + text[at:].replace(f"{other}=", f"{label}=", 1)
    for verification in map(single, (text, swapped)):
        assert verification.verdict is Verdict.DIFFERS
        assert Kind.LABEL in {finding.kind for finding in verification.findings}


# --- both sides of the constants that decide a verdict --------------------------------------------

MACHINE = BODY.replace("IB=", "1B=").replace("MU=", "NU=").replace("MB=", "M8=")


def test_from_three_misread_characters_on_only_a_digit_for_another_differs() -> None:
    for old, new, verdict in (
        ("VBY= 19.982", "VBY= 19.92", Verdict.INCOMPLETE),
        ("VBY= 19.982", "VBY= -19.982", Verdict.INCOMPLETE),
        ("VBY= 19.982", "VBY= 1.9982", Verdict.INCOMPLETE),
        ("VBY= 19.982", "VBY= 19982", Verdict.AS_READ),
        ("E= 5E-03 ", "E= 5E-05 ", Verdict.DIFFERS),
    ):
        assert single(BODY.replace(old, new)).verdict is Verdict.DIFFERS
        two = MACHINE.replace("M8=", "MB=").replace(old, new)
        assert single(two).verdict is Verdict.DIFFERS
        verification = single(MACHINE.replace(old, new))
        assert verification.verdict is verdict
        assert old.partition("=")[0] in {finding.name for finding in verification.findings}
    assert single(MACHINE.replace("VBY= 19.982", "VBY= 19.952")).verdict is Verdict.DIFFERS


def test_the_same_misreading_twice_is_open() -> None:
    once = MACHINE.replace("15.91", "16.91")
    assert single(once).verdict is Verdict.DIFFERS
    assert single(once.replace("57.47", "67.47")).verdict is Verdict.INCOMPLETE


def test_up_to_two_numbers_differ_on_a_page_that_a_machine_read() -> None:
    two = MACHINE.replace("15.91", "16.91").replace("57.47", "57.48")
    assert single(two).verdict is Verdict.DIFFERS
    assert single(two.replace("3.449", "3.499")).verdict is Verdict.INCOMPLETE


def test_three_numbers_make_a_printout() -> None:
    assert judge("MA= 1 MB= 2 IA= 3\n")
    assert not judge("MA= 1 MB= 2\n")
    assert not judge("MA= 1 M= 2 I= 3\n")


def test_a_row_further_up_begins_another_printout() -> None:
    assert len(judge(BODY + "\n" + BODY)) == 2
    assert len(judge(with_row("UX=", row("UX="), row("MA=")))) == 1  # four rows
    assert len(judge(with_row("VX=", row("VX="), row("MA=")))) == 2


def test_a_number_cut_at_the_end_of_its_line_is_not_read() -> None:
    assert single(BODY.replace("XB= 14.51 YB= 25.14", "XB= 14.51 YB= 25.1")).verdict is (
        Verdict.INCOMPLETE
    )
    assert single(BODY.replace("XB= 14.51", "XB= 14.5")).verdict is Verdict.DIFFERS


def test_the_verdict_is_the_gravest_of_the_table() -> None:
    assert set(VERDICTS) == set(Kind) == set(SENTENCES)
    for text in (PAGE, BODY.replace("DA=", "0A="), BODY.replace("3.449", ""), with_row("VAX=")):
        verification = single(text)
        verdicts = [VERDICTS[finding.kind] for finding in verification.findings]
        assert verification.verdict is min([*verdicts, Verdict.IDENTICAL], key=[*Verdict].index)


def test_the_guide_has_the_table_of_the_code() -> None:
    guide = ROOT / "port" / "docs" / "guide" / "verify-method.md"
    assert verdict_table() in guide.read_text(encoding="utf-8")


# --- properties -----------------------------------------------------------------------------------


@settings(max_examples=20, deadline=None)
@given(st.integers(0, len(BODY) - 1), st.sampled_from("0123456789.-AEKX=~ "), st.booleans())
def test_findings_quote_the_page(at: int, char: str, is_added: bool) -> None:
    text = BODY[:at] + char + BODY[at + (not is_added) :]
    for verification in judge(text):
        for finding in verification.findings:
            assert finding.read == text[finding.start : finding.stop] or not finding.read
        for name, number in verification.numbers.items():
            assert number.read in text, name
        if verification.verdict is Verdict.IDENTICAL:
            again = impact88.run(verification.scene).page
            printed = again[again.index("MA=") :]
            assert "".join(printed.split()) == "".join(text.upper().split())


# --- given inputs, copies, explanations, words ----------------------------------------------------


def test_results_alone_go_with_given_inputs() -> None:
    results = BODY[BODY.index("INITIAL") :]
    assert single(results).verdict is Verdict.INCOMPLETE
    (verification,) = verify(results, impact88.sample(1))
    assert verification.verdict in (Verdict.IDENTICAL, Verdict.AS_READ)
    (other,) = verify(results, {**impact88.sample(1), "MA": "150"})
    assert other.verdict is Verdict.DIFFERS


def test_a_given_input_of_which_the_page_has_another_value_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(UserError, match=r"the page has MU \.911, but \.5 is given"):
        verify(PAGE, {"MU": ".5"})
    (same,) = verify(PAGE, {**impact88.sample(1), "MU": "0.911", "MA": 143.50})
    assert same.verdict is Verdict.IDENTICAL


COPIES = {
    "another pi": ("3.14159265", "3.1416"),
    "a renamed label": ('"MA= "', '"MASS A= "'),
    "a further line": ("640 PRINT", '635 PRINT "OFFICE OF J. HILL"\n640 PRINT'),
}


@pytest.mark.parametrize("name", COPIES)
def test_a_page_of_an_offices_copy_is_identical_to_what_the_copy_prints(
    name: str, tmp_path: Path
) -> None:
    assert COPIES[name][0] in LISTING
    path = tmp_path / "office.bas"
    path.write_text(LISTING.replace(*COPIES[name]), encoding="utf-8")
    page = ListingCopy(str(path)).run(impact88.sample(1)).page
    assert [v.verdict for v in verify(page, listing=path)] == [Verdict.IDENTICAL]
    assert [v.verdict for v in verify(page)] != [Verdict.IDENTICAL]
    altered = page.replace("KE LOSS= 5", "KE LOSS= 6")
    (verification,) = verify(altered, listing=path)
    assert [finding.name for finding in verification.findings] == ["LOSS"]
    assert verification.verdict is Verdict.DIFFERS


SCENE = impact88.sample(1)
OTHER_MU = {**SCENE, "MU": "-" + SCENE["MU"]}


def results(page: str) -> str:
    return page[page.index("INITIAL KE") :]


@pytest.mark.parametrize(
    ("text", "explanation"),
    [
        (BODY.replace("3728", "3778"), "line 1: IA 3778 is a slip, or edited later"),
        (BODY.replace("3.449", "3.559"), "line 18: VAY 3.559 is not"),
        (
            BODY.replace(results(BODY), results(impact88.run(OTHER_MU).page)),
            "the other sign of MU (line 400)",
        ),
        (
            BODY.replace(results(BODY), results(impact88.run({**SCENE, "M": "4"}).page))
            .rstrip()
            .removesuffix("*****")
            + " WA= 0 WB= 0\n\n*****\n",
            "computed with M = 4 (line 350); but not WAF, WBF",
        ),
        (run(SCENE, FLOAT32).page, "computed in single precision"),
    ],
    ids=["an input", "a result", "sign of MU", "M", "single precision"],
)
def test_explanations(text: str, explanation: str) -> None:
    verification = single(text)
    assert verification.verdict is Verdict.DIFFERS
    assert explanation in verification.explanation
    assert "; line" not in verification.explanation


def test_results_alone_computed_with_another_m() -> None:
    (verification,) = verify(results(impact88.run({**SCENE, "M": "4"}).page), SCENE)
    assert verification.verdict is Verdict.DIFFERS
    assert verification.explanation == "computed with M = 4 (line 350)"


@pytest.mark.captures
def test_explanations_name_another_arithmetic_or_m() -> None:
    named = []
    for item in random.Random(2).sample(captures.scenes(), 24):
        if item["scene"]["M"] != "6" or "VAX=" not in item["printout"]:
            continue
        page = impact88.run(item["scene"], "float64").page
        (verification,) = judge(page[page.index("MA=") :])
        differing = [f for f in verification.findings if f.kind is Kind.NUMBER]
        if verification.verdict is Verdict.DIFFERS and len(differing) > 2:
            named.append("double precision" in verification.explanation)
    assert sum(named) >= 0.6 * len(named)


def test_words_and_json() -> None:
    altered = single(PAGE.replace("3.449", "3.549"))
    text = "\n".join(words.write(altered, "case.txt", 2, brief=True))
    assert text.startswith("case.txt, printout 2 (line 2): DIFFERS")
    assert "VAY '3.549': the program prints 3.449" in text
    assert "scene as typed" in "\n".join(words.write(altered))
    answer = json.loads(json.dumps(words.record(altered, "case.txt")))
    assert answer["schema"] == "impact88/verify/4"
    assert answer["findings"][0]["kind"] == "number"
    assert PAGE[slice(*[answer["findings"][0][key] for key in ("start", "stop")])] == "3.449"


def test_what_is_no_printout_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(UserError, match="no printout"):
        verify("Dear Sir,\nnothing here\n")
    with pytest.raises(UserError):
        verify(tmp_path / "none.txt")
    picture = tmp_path / "page.png"
    picture.write_bytes(b"\x89PNG\r\n\x1a\n")
    with pytest.raises(UserError):
        verify(picture)
