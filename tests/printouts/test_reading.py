"""Reading printouts as text."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import zip_longest

import captures
import pytest
from longer import long_but

import impact88
import printouts
from impact88.collision.fields import ANGLES, FIELDS
from impact88.errors import UserError
from impact88.printouts.reading import glyphs
from impact88.printouts.reading.alignment import WINDOW, Budget, align
from impact88.printouts.reading.numerals import candidates, rows
from impact88.printouts.reading.plaintext import decode
from impact88.printouts.reading.printout import read_printouts
from printouts import SAMPLE


def texts(printout: str) -> dict[str, str]:
    (shown,) = read_printouts(printout)
    return {name: reading.text for name, reading in shown.fields.items()}


@pytest.mark.captures
def test_captured_printouts_read_field_by_field() -> None:
    """Against places found by the listing's layout, not by the reader."""
    checked = 0
    for row in printouts.sampled(printouts.normal_ends(), 12):
        expected = {
            place.name: row["printout"][place.start : place.stop]
            for place in printouts.places(row["printout"])
        }
        assert texts(row["printout"]) == expected
        checked += 1
    assert checked


@pytest.mark.captures
def test_captured_errors_and_replies_are_read() -> None:
    endings = {}
    for row in printouts.sampled(captures.scenes(), 18):
        (shown,) = read_printouts(row["printout"])
        typed = ",".join(row["keyboard"]).split(",")
        assert [reading.text for reading in shown.replies.values()] == typed
        tail = row["printout"].split("\n?")[-1] if "ERROR" in row["printout"] else ""
        assert (shown.ending or "").lstrip("?") in (tail.replace("\a", ""), "ZERO DETERMINANT")
        endings[shown.ending] = True
    assert None in endings


@pytest.mark.captures
@pytest.mark.parametrize("how", long_but(printouts.MANGLED, kept=(0, 1, 2)))
def test_blanks_and_line_breaks_do_not_matter(how: str) -> None:
    for row in printouts.sampled(printouts.normal_ends(), 1):
        (plain,) = read_printouts(row["printout"])
        (shown,) = read_printouts(printouts.MANGLED[how](row["printout"]))
        for name in FIELDS:
            if name in plain.fields and name not in ANGLES:
                ways = candidates(shown.fields[name].region, 6)
                assert plain.fields[name].text in [text for text, _ in ways], name
        rows = [tuple(shown.fields[name].text for name in ANGLES if name in shown.fields)]
        rows += [row.texts for row in shown.angles]
        assert tuple(plain.fields[name].text for name in ANGLES) in rows
        if how in printouts.MANGLED_HARMLESSLY:
            assert rows[0] == tuple(plain.fields[name].text for name in ANGLES)


def test_letters_stand_for_digits_only_where_a_number_must_stand() -> None:
    found = texts(SAMPLE.replace("143.5", "l43.5").replace("60", "6O").replace("IA=", "lA="))
    assert (found["MA"], found["TB"], found["IA"]) == ("143.5", "60", "3728")


FIGURES = "0123456789"
SHAPES = {}
"""Look-alike -> the glyphs of numbers that it may stand for."""
for _printed, *_shapes in glyphs._CHANNEL["number shapes"]:
    for _shape in "".join(_shapes):
        SHAPES.setdefault(_shape, []).append(_printed)


def pages_with(look_alike: str) -> Iterator[tuple[str, str, str]]:
    """A field, its text, and the page on which the look-alike stands in the field's place for a
    glyph that it may stand for."""
    plain = texts(SAMPLE)
    for printed in SHAPES[look_alike]:
        for name, text in plain.items():
            at = text.find(printed, 0 if printed in "-." else 1)
            damaged = f"{name}= {text[:at]}{look_alike}{text[at + 1 :]}"
            if at >= 0 and f"{name}= {text}" in SAMPLE:
                yield name, text, SAMPLE.replace(f"{name}= {text}", damaged)


@pytest.mark.parametrize("look_alike", long_but(SHAPES, kept=range(0, len(SHAPES), 4)))
def test_every_look_alike_is_read_for_a_glyph_that_it_stands_for(look_alike: str) -> None:
    for name, text, page in pages_with(look_alike):
        (shown,) = read_printouts(page)
        if name in shown.fields:
            readings = candidates(shown.fields[name].region, 6)
            if text in [reading for reading, _ in readings]:
                return
    pytest.fail(
        f"{look_alike} stands for {' '.join(SHAPES[look_alike])} in [number shapes] of "
        "printouts/reading/channel.txt, and is read for none of them; next step: `candidates` "
        "in printouts/reading/numerals.py"
    )


def test_a_rarer_reading_of_a_look_alike_costs_little_more() -> None:
    """So little that the numbers of the page decide."""
    several = [costs for look_alike in SHAPES if len(costs := glyphs.printed_for(look_alike)) > 1]
    assert several
    for costs in map(list, map(dict.values, several)):
        assert costs == sorted(costs)
        assert 0.3 == costs[0] <= costs[-1] < 0.5


def test_no_figure_is_a_look_alike_of_another() -> None:
    """A figure read for a figure contradicts the page: no table excuses it."""
    for section in ("numbers", "number shapes"):
        for printed, *readings in glyphs._CHANNEL[section]:
            shapes = "".join(readings) if "shapes" in section else [r[0] for r in readings[1:]]
            for figure in FIGURES:
                assert figure not in shapes, (
                    f"a {figure} read for {printed} contradicts the page; next step: take it out "
                    f"of [{section}] in printouts/reading/channel.txt"
                )


def test_every_kind_of_minus_and_a_leading_zero() -> None:
    for minus in "−–—‐‑":
        assert texts(SAMPLE.replace("-", minus)) == texts(SAMPLE)
    assert texts(SAMPLE.replace(" .911", " 0.911"))["MUP"] == "0.911"  # a finding, not the same


def test_illegible_characters_stay_question_marks() -> None:
    assert texts(SAMPLE.replace("143.5", "1?3.5"))["MA"] == "1?3.5"
    assert texts(SAMPLE.replace("143.5", "1§3.5"))["MA"] == "1?3.5"


def test_what_cannot_be_read_is_named_with_its_place() -> None:
    (shown,) = read_printouts(SAMPLE.replace("IA= 3728", "IA= (torn)"))
    (remark,) = shown.remarks
    assert "IA" not in shown.fields
    assert remark.startswith("line 1, column 24: IA: ")


@pytest.mark.parametrize(
    ("typed", "numbers", "remarks"),
    [
        ("-29.04,0,0", 3, ""),
        ("-29.04,0,0,7", 3, "'7' after the third number"),
        ("-29.04,0", 0, "'-29.04,0' is not three numbers"),
    ],
)
def test_a_reply_is_three_numbers(typed: str, numbers: int, remarks: str) -> None:
    """INPUT ignores what follows the third, and asks again after two."""
    prompt = "ENTER THE INITIAL VELOCITY COMPONENTS OF MA :Vax,Vay,Wa ?"
    (shown,) = read_printouts(f"{prompt}{typed}\n\n{SAMPLE}")
    assert [one.text for one in shown.replies.values()] == ["-29.04", "0", "0"][:numbers]
    on_reply = [one.partition("reply: ")[2] for one in shown.remarks if "reply: " in one]
    assert on_reply == [remarks] * bool(remarks)
    assert "the prompt of MB is missing" in shown.remarks


def test_several_printouts_with_text_between() -> None:
    text = (
        f"Exhibit 7, DATE= 1989\n{SAMPLE}\nSee MA below.\f{SAMPLE.replace('143.5', '96')}appendix"
    )
    first, second = read_printouts(text)
    assert (first.line, second.line) == (2, SAMPLE.count("\n") + 3)
    assert (first.text("MA"), second.text("MA")) == ("143.5", "96")
    assert len(first.fields) == len(second.fields) == len(FIELDS)


def test_the_basic_listing_is_no_printout() -> None:
    listing = '310 MA = 143.5:MB = 95.8:IA = 3728:IB = 1961\n620 PRINT "MA= ";MA;" MB= ";MB\n'
    assert len(read_printouts(listing + SAMPLE)) == 1


def test_error_messages_end_a_printout() -> None:
    head = SAMPLE[: SAMPLE.index("57.47")]
    (shown,) = read_printouts(head + "\n?DIVISION BY ZER0 ERROR\a IN 69O")
    assert shown.ending == "?DIVISION BY ZERO ERROR IN 690"
    assert "LOSS" not in shown.fields
    assert not shown.remarks


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be"])
def test_encodings(encoding: str) -> None:
    (shown,) = printouts.from_bytes(SAMPLE.replace("\n", "\r").encode(encoding), "page")
    assert {name: reading.text for name, reading in shown.fields.items()} == texts(SAMPLE)


@pytest.mark.parametrize("encoding", ["utf-16-le", "utf-16-be"])
def test_two_bytes_a_character_are_seen_without_their_mark(encoding: str) -> None:
    """Typographic signs, too, whose bytes hold no zero."""
    page = SAMPLE.replace("-", "−")
    assert decode(page.encode(encoding), "page") == page


DASHED = SAMPLE.replace("-", "–")


@pytest.mark.parametrize(
    "data",
    [
        DASHED.replace(" ", "\xa0").encode("cp1252"),
        ("Gutachten für Müller, § 14\n" + DASHED).encode("cp1252"),
        ("Café\n" + DASHED).encode("mac_roman"),
        ("Привет\n" + DASHED).encode(),
        DASHED.encode().decode("cp1252").encode(),
        bytes(byte | 0x80 for byte in SAMPLE.replace("\n", "\r").encode()),
        SAMPLE.encode("cp037"),
        SAMPLE.encode("utf-32"),
        SAMPLE.replace("=", "=3D").replace("VAX", "VA=\nX").encode(),
        SAMPLE.encode() + b"\x1a" * 90,
        SAMPLE.replace("\n", "\v").encode(),
    ],
)
def test_a_file_is_read_in_the_encoding_that_leaves_least_foreign(data: bytes) -> None:
    (shown,) = printouts.from_bytes(data, "page")
    assert {name: reading.text for name, reading in shown.fields.items()} == texts(SAMPLE)
    assert shown.page.text.count("\n") >= SAMPLE.count("\n")


def test_a_minus_may_belong_to_the_label_only_where_the_label_has_no_equals_sign() -> None:
    for printed, sign_free in (("MA= 143.5", False), ("MA= -143.5", False), ("MA - 143.5", True)):
        (shown,) = read_printouts(SAMPLE.replace("MA= 143.5", printed))
        assert shown.fields["MA"].sign_free is sign_free
        assert not shown.fields["PA"].sign_free


def test_unreadable_files_are_refused() -> None:
    with pytest.raises(UserError, match="is not UTF-8 text"):
        printouts.from_bytes(bytes(range(256)) * 40, "file")
    with pytest.raises(UserError, match="no printout"):
        printouts.from_bytes(b"nothing of the kind", "file")


def test_truncated_anywhere_reads_or_is_refused() -> None:
    for stop in range(0, len(SAMPLE), 29):
        try:
            (shown,) = read_printouts(SAMPLE[:stop])
        except UserError:
            assert stop < SAMPLE.index("IA=")
            continue
        whole = [name for name, reading in shown.fields.items() if not reading.cut]
        expected = texts(SAMPLE)
        assert all(shown.text(name) == expected[name] for name in whole if name not in ANGLES)


@pytest.mark.parametrize(
    "row",
    ["-19.8 -38.7 C) 60 -30", "-19.8-38.7060-30", "-19. 8 ~38.7 0 60 -3 0", "-19.8 -38.7 0 6? -30"],
)
def test_a_row_that_blanks_do_not_divide_is_parted_in_likely_ways(row: str) -> None:
    read = rows(glyphs.Page(row).glyphs, len(ANGLES))
    assert ("-19.8", "-38.7", "0", "60", "-30") in [way.texts for way in read[:20]]
    assert [way.cost for way in read] == sorted(way.cost for way in read)


@pytest.mark.parametrize("note", ["\n   177\n", "seen 1988\n", "12\n", "-8.78\n", "VAX= 3.449\n"])
@pytest.mark.parametrize("number", long_but([1, 2, 3]))
def test_what_stands_below_the_angles_is_none_of_them(number: int, note: str) -> None:
    page = impact88.run(impact88.sample(number)).page
    end = page.index("\n", page.index("TB GA\n") + len("TB GA\n")) + 1
    (read,) = impact88.read_printouts(page[:end] + note + page[end:])
    (exact,) = impact88.read_printouts(page)
    assert [read.fields[name].text for name in ANGLES] == [
        exact.fields[name].text for name in ANGLES
    ]
    (verification,) = impact88.verify(page[:end] + note + page[end:])
    assert verification.verdict.name == "IDENTICAL_AS_READ"


# --- one printout, or two ------------------------------------------------------------------------


@pytest.mark.captures
@pytest.mark.parametrize("glyphs", long_but([" ", "\n", "\f", " \n\r\f\t"], kept=(3,)))
def test_blanks_breaks_and_form_feeds_anywhere_part_no_printout(glyphs: str) -> None:
    """Where they cut the row of angles into more than five pieces, too."""
    for seed, row in enumerate(printouts.sampled(printouts.normal_ends(), 3, seed=37)):
        page = row["printout"] if seed % 2 else printouts.body(row["printout"])
        for chance in (0.08, 0.3):
            assert len(read_printouts(printouts.sprinkled(page, glyphs, chance, seed))) == 1


def side_by_side(left: str, right: str, gap: int) -> str:
    rows = [*zip_longest(left.split("\n"), right.split("\n"), fillvalue="")]
    width = max(len(first) for first, _ in rows) + gap
    return "\n".join(first.ljust(width) + second for first, second in rows)


@pytest.mark.captures
def test_printouts_side_by_side_are_read_each_in_its_column() -> None:
    first, second, third = (row["printout"] for row in printouts.normal_ends()[20:23])
    first, second, third = map(printouts.body, (first, second, third))
    for page, count in (
        (side_by_side(first, second, 2), 2),
        (side_by_side(first, "\n\n\n" + second, 8), 2),
        (side_by_side(first, side_by_side(second, third, 4), 4), 3),
    ):
        read = read_printouts(page)
        assert [printout.text("MA") for printout in read] == [
            texts(printout)["MA"] for printout in (first, second, third)[:count]
        ]
        place = read[1].fields["MA"]
        line = page.split("\n")[place.line - 1]
        assert line[place.column - 1 :].startswith(place.text)
        assert [impact88.verify(printout).verdict.name for printout in read] == [
            "IDENTICAL"
        ] * count


@pytest.mark.parametrize(("marks", "count"), [(980, 1), (1020, 2)])
def test_a_page_goes_on_behind_half_a_page_of_other_text(marks: int, count: int) -> None:
    page = impact88.run(impact88.sample(1)).page
    at = page.index("UX=")
    text = glyphs.Page(page[:at] + "#" * marks + "\n" + page[at:]).glyphs
    assert len([*align(text, 0, len(text), Budget(), ())]) == count


def test_a_page_that_is_found_fills_the_budget_again() -> None:
    """More than fits into one window: what is left of a small budget would end it."""
    page = impact88.run(impact88.sample(1)).page
    count = WINDOW // len(glyphs.Page(page).glyphs) + 2
    text, budget = glyphs.Page(page * count).glyphs, Budget(left=1)
    assert len([*align(text, 0, len(text), budget, ())]) == count
    assert budget.stopped is None
