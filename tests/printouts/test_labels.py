"""Labels and left-over lines: what a page says beside its numbers is part of the page."""

from __future__ import annotations

import random
import re
from collections import Counter

import pytest
from longer import long_but

import printouts
from impact88.printouts.reading.differences import Kind
from impact88.printouts.reading.printout import read_printouts
from impact88.printouts.reporting.examination import Verdict, Verification, verify
from impact88.printouts.reporting.verification import lines
from printouts import SAMPLE

pytestmark = pytest.mark.usefixtures("verdicts_alone")
LABEL = re.compile("(INITIAL KE|KE LOSS|VAX|VAY|VBX|VBY|[MIDWXY][AB]|[UV][XY]|MU|EM|E)=")
LABELS = tuple(dict.fromkeys(LABEL.findall(SAMPLE)))
HEADING = "PA PB TA TB GA"
ACROSS = {"A": "B", "B": "A", "U": "V"}
PAGES = printouts.SWEEP or 4
"""Pages of every kind; the whole 2,000 in a sweep of 400."""


def verdicts(text: str) -> set[Verdict]:
    return {verify(one).verdict for one in read_printouts(text)}


def one(text: str) -> Verification:
    (shown,) = read_printouts(text)
    return verify(shown)


def exchanged(text: str, rng: random.Random) -> str:
    """Two labels in each other's place."""
    found = list(LABEL.finditer(text))
    first, second = sorted(rng.sample(found, 2), key=re.Match.start)
    if first[1] == second[1]:
        return exchanged(text, rng)
    middle = text[first.end(1) : second.start(1)]
    return text[: first.start(1)] + second[1] + middle + first[1] + text[second.end(1) :]


def relabelled(text: str, rng: random.Random, new: str) -> str:
    found = rng.choice([one for one in LABEL.finditer(text) if one[1] != new])
    return text[: found.start(1)] + new + text[found.end(1) :]


def another(text: str, rng: random.Random) -> str:
    """Another label of the program's."""
    return relabelled(text, rng, rng.choice(LABELS))


def of_the_other_side(text: str, rng: random.Random) -> str:
    """The label of the other vehicle."""
    vehicles = re.compile("([MIDWXY][AB]|V[AB][XY]|U[XY])=")
    found = rng.choice(list(vehicles.finditer(text)))
    new = re.sub("[ABU]", lambda letter: ACROSS[letter[0]], found[1])
    return text[: found.start(1)] + new + text[found.end(1) :]


def nonsense(text: str, rng: random.Random) -> str:
    """A word that is no label."""
    letters = rng.choices("ABCDEFGHIJKLMNOPQRSTUVWXYZ", k=rng.choice((2, 3, 4)))
    return relabelled(text, rng, "".join(letters))


def angles(text: str, rng: random.Random) -> str:
    """Two of the heading's."""
    names = HEADING.split()
    first, second = rng.sample(range(len(names)), 2)
    names[first], names[second] = names[second], names[first]
    return text.replace(HEADING, " ".join(names))


WRONG = (exchanged, another, of_the_other_side, nonsense, angles)


@pytest.mark.captures
@pytest.mark.parametrize("how", long_but(WRONG, kept=(0, 1)), ids=lambda how: how.__name__)
def test_a_wrong_label_is_never_identical(how) -> None:  # type: ignore[no-untyped-def]
    rng = random.Random(how.__name__)
    rows = printouts.normal_ends()
    count: Counter[bool] = Counter()
    for _ in range(PAGES):
        found = verdicts(how(rng.choice(rows)["printout"], rng))
        assert Verdict.IDENTICAL not in found
        count[Verdict.DIFFERS in found] += 1
    assert count[True] >= 0.98 * count.total()


def test_results_given_to_the_other_vehicle() -> None:
    text = SAMPLE.replace("VAX=", "V@X=").replace("VBX=", "VAX=").replace("V@X=", "VBX=")
    result = one(text)
    assert result.verdict is Verdict.DIFFERS
    assert result.explanations[0].kind == "labels exchanged"
    said = "\n".join(lines(result))
    assert re.search(r"line [0-9]+: labelled VBX where the program prints VAX", said)


@pytest.mark.parametrize("name", ["MA", "UY", "VAX", "KE LOSS", "WB"])
def test_a_missing_label_is_told(name: str) -> None:
    result = one(SAMPLE.replace(f"{name}= ", "", 1))
    assert result.verdict is Verdict.IDENTICAL_AS_READ
    assert [label.kind for label in result.labels].count(Kind.MISSING) == 1
    assert f"the program prints {name.replace(' ', '')}" in "\n".join(lines(result))


@pytest.mark.parametrize(
    ("old", "new"),
    [("VAX=", "VAK="), ("INITIAL", "1NITIAL"), ("VAY=", "UAY="), ("LOSS", "LOAS")],
)
def test_a_damaged_label_leaves_a_doubt_on_a_page_that_no_machine_read(old: str, new: str) -> None:
    result = one(SAMPLE.replace(old, new, 1))
    assert result.verdict is Verdict.IDENTICAL_AS_READ
    (damaged,) = (label for label in result.labels if label.kind is Kind.LOOK_ALIKE)
    assert damaged.bears
    assert f"line {damaged.line}: the label" in "\n".join(lines(result))


def test_a_machine_may_misread_letters_that_no_other_label_has() -> None:
    """Shown to be machine-read, here by three other letters."""
    read = SAMPLE.replace("INITIAL KE", "1N1T1AL KE")
    for old, new, doubt in (("VAX=", "VAK=", True), ("VAY=", "UAY=", False)):
        result = one(read.replace(old, new, 1))
        assert result.verdict is (Verdict.IDENTICAL_AS_READ if doubt else Verdict.IDENTICAL)


def test_a_label_that_the_reader_of_the_page_made_another_is_damaged() -> None:
    """U for V throughout, as readers of worn type have it; alone it contradicts."""
    alone = SAMPLE.replace("VX=", "UX=", 1)
    assert one(alone).verdict is Verdict.DIFFERS
    worn = alone.replace("VAX=", "UAX=").replace("VAY=", "UAY=").replace("VBX=", "UBX=")
    assert one(worn).verdict is Verdict.IDENTICAL_AS_READ


@pytest.mark.parametrize(
    ("text", "bars"),
    [
        ("CORRECTION: VAX should read -19.263, LOSS 75 %", True),
        ("DELTA-V A= 99.99", True),
        ("see VBY", True),
        ("PAGE 640", False),
        ("ALL VELOCITIES IN MPH", False),
        ("checked by hand", False),
    ],
)
@pytest.mark.parametrize("where", ["above", "inside", "below"])
def test_a_line_that_is_none_of_the_programs_is_told_whole(
    text: str, bars: bool, where: str
) -> None:
    first, second = SAMPLE.split("UX=", 1)
    page = {
        "above": f"{text}\n\n{SAMPLE}",
        "inside": f"{first}{text}\n\nUX={second}",
        "below": f"{SAMPLE}\n\n{text}\n",
    }[where]
    result = one(page)
    bars = bars or where == "inside"
    assert result.verdict is (Verdict.IDENTICAL_AS_READ if bars else Verdict.IDENTICAL)
    assert [piece.read for piece in result.left_over if piece.kind is Kind.FOREIGN_LINE] == [text]
    assert text in "\n".join(lines(result))


def test_figures_at_the_place_of_the_asterisks_are_told() -> None:
    for text in ("x= 5", "PAGE 2"):
        result = one(SAMPLE.replace("*****", f"{text}\n*****", 1))
        assert result.verdict is Verdict.IDENTICAL_AS_READ
        assert text in "\n".join(lines(result))


def test_what_follows_a_page_on_its_last_line_is_told() -> None:
    result = one(f"{SAMPLE.rstrip()} and LOSS 75 %\n")
    assert result.verdict is Verdict.IDENTICAL_AS_READ


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("-", "\N{EN DASH}", "en dash"),
        ("5", "\N{FULLWIDTH DIGIT FIVE}", "fullwidth digit five"),
        ("3.449", "\N{MATHEMATICAL BOLD DIGIT THREE}.449", "the first at line 18, column 19"),
        ("MA=", "M\N{ZERO WIDTH SPACE}A=", "1 zero width space; the first at line 1, column 2"),
        ("MA=", "MA=\0", "1 NUL"),
        ("LOSS", "L\bLO\bOS\bSS\bS", "4 backspace"),
    ],
)
def test_characters_read_as_plain_ones_are_counted(old: str, new: str, told: str) -> None:
    result = one(SAMPLE.replace(old, new))
    assert result.verdict is Verdict.IDENTICAL
    assert any(told in remark for remark in result.remarks)


@pytest.mark.parametrize(
    "figure", ["\N{MATHEMATICAL BOLD DIGIT EIGHT}", "\N{FULLWIDTH DIGIT EIGHT}"]
)
def test_another_figure_in_another_typeface_differs(figure: str) -> None:
    assert one(SAMPLE.replace("3.449", f"{figure}.449")).verdict is Verdict.DIFFERS


@pytest.mark.parametrize(
    "letter", ["\N{CYRILLIC CAPITAL LETTER KA}", "\N{GREEK CAPITAL LETTER KAPPA}"]
)
def test_a_letter_of_another_script_is_a_doubt_in_a_label(letter: str) -> None:
    result = one(SAMPLE.replace("INITIAL KE", f"INITIAL {letter}E"))
    assert result.verdict is Verdict.IDENTICAL_AS_READ


@pytest.mark.parametrize(
    "number",
    long_but([
        "-\u202e13.263\u202c", "-1\b3.263", "-13.\u2066263", "-13.2\x7f63", "-13.263\U000e0031",
        "-13.263\x1b[8m7\x1b[0m",
    ], kept=(0, 1)),
)  # fmt: skip
def test_what_changes_how_a_number_is_shown_bars_identical(number: str) -> None:
    result = one(SAMPLE.replace("-13.263", number))
    assert result.verdict is not Verdict.IDENTICAL
    assert "line 18, column" in "\n".join(lines(result))


def test_a_number_without_its_label_is_no_part_of_the_reply_above_it() -> None:
    prompt = "ENTER THE INITIAL VELOCITY COMPONENTS OF MB :Vbx,Vby,Wb ?"
    (printed,) = read_printouts(SAMPLE)
    typed = ",".join(printed.text(name) or "" for name in ("VX", "VY", "WB"))
    (shown,) = read_printouts(f"{prompt}{typed}\n\n{SAMPLE}".replace("MA= ", " ", 1))
    assert shown.replies["WB"].text == printed.text("WB")
    assert verify(shown).verdict is Verdict.IDENTICAL_AS_READ


@pytest.mark.long
def test_a_reply_never_outranks_the_printed_number() -> None:
    prompt = "ENTER THE INITIAL VELOCITY COMPONENTS OF MA :Vax,Vay,Wa ?"
    other = prompt.replace("MA", "MB").replace("Va", "Vb").replace("Wa", "Wb")
    text = f"{prompt}-29.04,0,0\n\n{other}14.52,25.15,0\n\n{SAMPLE}"
    assert one(text).verdict is Verdict.IDENTICAL
    assert one(text.replace("Wa ?", "W8 7")).verdict is Verdict.IDENTICAL_AS_READ
    assert one(text.replace("?-29.04", "?87-29.04")).verdict is not Verdict.IDENTICAL
    assert one(text.replace("?-29.04", "?-29.84")).verdict is Verdict.DIFFERS


PREFIXES = (
    *("{} ", "{}: ", "{:3}| ", "[{}] ", "{:04} ", "run7.txt:{}:", "[10:33:{:02}] "),
    *("2024-01-03 10:33:{:02} ", "> ", "• ", "- "),
)


def prefixed(prefix: str, text: str, blank: bool = True) -> list[str]:
    """The lines of a text, with something before each."""
    return [
        prefix.format(count) + line if blank or line.strip() else line
        for count, line in enumerate(text.split("\n"), 1)
    ]


@pytest.mark.parametrize("prefix", long_but(PREFIXES, kept=(0, 3, 6, 8)))
@pytest.mark.parametrize("blank", [True, False])
def test_what_stands_before_every_line_is_no_part_of_the_page(prefix: str, blank: bool) -> None:
    result = one("\n".join(prefixed(prefix, SAMPLE, blank)))
    assert result.verdict is Verdict.IDENTICAL
    assert any(prefix.format(1)[:1] in remark for remark in result.remarks)


@pytest.mark.parametrize("prefix", long_but(PREFIXES[::3]))
def test_what_stands_before_some_lines_only_bars_identical(prefix: str) -> None:
    numbered = prefixed(prefix, SAMPLE)
    numbered[5] = SAMPLE.split("\n")[5]
    assert Verdict.IDENTICAL not in verdicts("\n".join(numbered))


@pytest.mark.parametrize("prefix", long_but(["1", "{}", "-", ".", "5 "], kept=(0, 1)))
def test_figures_before_every_line_that_number_none_bar_identical(prefix: str) -> None:
    assert Verdict.IDENTICAL not in verdicts("\n".join(prefixed(prefix, SAMPLE, False)))
    falling = prefixed("{} ", SAMPLE, False)
    assert Verdict.IDENTICAL not in verdicts("\n".join([*falling[4:], *falling[:4]]))


@pytest.mark.parametrize("text", ["5x10^-3", "5 x 10^-3", "5*10^-3", "5x10-3", "5×10⁻³"])
def test_a_power_of_ten_written_out_is_retyped(text: str) -> None:
    assert one(SAMPLE.replace("5E-03", text)).verdict is Verdict.IDENTICAL_AS_READ


def test_a_point_in_a_reply_parts_no_thousands() -> None:
    """On a page that ends before its first printed number."""
    prompt = "ENTER THE INITIAL VELOCITY COMPONENTS OF M{} :V{}x,V{}y,W{} ?"
    first, second = (prompt.format(side, *3 * side.lower()) for side in "AB")
    result = one(f"{first}-86.903,0,1.204\n\n{second}12.345,7.881,0\n\n?OVERFLOW ERROR IN 320\n")
    assert result.scene["UX"] == "-86.903"
    assert result.scene["VY"] == "7.881"


def test_labels_that_read_as_each_other_are_exchanged_whoever_read_the_page() -> None:
    """No reader takes each of two for the other."""
    worn = SAMPLE.replace("*****", "KKKKK").replace("INITIAL", "1NITIAL")
    text = worn.replace("VAX=", "V@X=").replace("VBX=", "VAX=").replace("V@X=", "VBX=")
    assert one(text).verdict is Verdict.DIFFERS


# --- every character belongs to the page, to a note that is shown, or bars IDENTICAL --------------


@pytest.mark.parametrize("note", ["(WRONG: 31.2)", "[31.2]", "WRONG, 31.2", "<- 31.2", "ft/s"])
@pytest.mark.parametrize("name", long_but(["MA", "UX", "LOSS", "VAX", "YBF"], kept=(1, 3)))
def test_a_note_typed_beside_a_genuine_number_is_told_and_accuses_nothing(
    note: str, name: str
) -> None:
    (place,) = [place for place in printouts.places(SAMPLE) if place.name == name]
    result = one(f"{SAMPLE[: place.stop]} {note}{SAMPLE[place.stop :]}")
    assert result.verdict is Verdict.IDENTICAL_AS_READ
    assert not result.differing
    said = "\n".join(lines(result))
    assert re.search(rf"{re.escape(note)}' left over beside a number", said)


@pytest.mark.parametrize("figures", long_but(["5", "31.2", "-1"]))
def test_figures_right_after_a_number_differ_and_are_shown_as_they_stand(figures: str) -> None:
    result = one(SAMPLE.replace("-13.263", f"-13.263 {figures}"))
    assert result.verdict is Verdict.DIFFERS
    (check,) = result.differing
    assert check.printed == f"-13.263 {figures}"


@pytest.mark.parametrize(("mark", "behind"), [("15.91)", "3"), ("57.47 %", " 3")])
def test_what_stands_behind_a_closing_mark_is_no_part_of_the_number(mark: str, behind: str) -> None:
    result = one(SAMPLE.replace(mark, mark + behind))
    assert result.verdict is Verdict.IDENTICAL_AS_READ
    assert [piece.read for piece in result.left_over] == ["3"]


INSERTED = (
    *("-", ".", "5", "+", "X", "=", "31.2", " -", " 5", "\n5\n", "\n-\n", " VOID", " (31.2)"),
    *(" <VAX 31.2>", "\nVAX= 31.2\n", "*", "(", ")", "%", ",", ":", "?", "E", "I", "O", "\x07"),
    *("\u200b", "~", "_", "|", "/", "<b>", "<s>", "#", "\n10 REM VAX= 31.2\n", "\n- ", "> "),
)


@pytest.mark.long
@pytest.mark.captures
def test_every_character_that_is_put_into_a_page_is_told() -> None:
    """Bare IDENTICAL only with a note that shows it."""
    rng = random.Random(41)
    rows = printouts.normal_ends()
    for number in range(printouts.SWEEP or 12):
        page = rng.choice(rows)["printout"]
        page = page if number % 2 else printouts.body(page)
        at, text = rng.randrange(len(page)), rng.choice(INSERTED)
        for result in map(verify, read_printouts(page[:at] + text + page[at:])):
            if result.verdict is Verdict.IDENTICAL:
                said = [line for line in lines(result) if line.startswith("  note:")]
                control = sum("characters read as plain ones" in line for line in said)
                assert len(said) > control or text in ("\x07", "\u200b"), (text, page[at - 20 : at])
                assert said, text


@pytest.mark.parametrize(
    ("old", "new"),
    [("INITIAL KE=", "INITIAL PN="), ("KE LOSS=", "KE GAIN="), ("INITIAL KE=", "SYSTEMS KE=")],
)
def test_another_word_of_a_label_of_two_contradicts(old: str, new: str) -> None:
    result = one(SAMPLE.replace(old, new))
    assert result.verdict is Verdict.DIFFERS
    assert not result.differing


def test_letters_read_as_others_are_told_where_they_leave_no_doubt() -> None:
    result = one(SAMPLE.replace("INITIAL", "1N1T1AL"))
    assert result.verdict is Verdict.IDENTICAL
    assert any("line 14: 1 for I" in remark for remark in result.remarks)


@pytest.mark.parametrize(
    ("page", "note"),
    [
        (SAMPLE.replace("MA= 143.5", "MA= <b>143.5</b>"), "markup passed over: 1 <b>, 1 </b>"),
        (f"10 REM VAX= 31.2\n{SAMPLE}", "the first is line 1: 10 REM VAX= 31.2"),
    ],
)
def test_markup_that_is_passed_over_is_named(page: str, note: str) -> None:
    assert any(note in remark for remark in one(page).remarks)


@pytest.mark.parametrize(
    "typed",
    [
        '735 PRINT "THE SPEED OF A IS 12.3"', '<p VAX="12.3">', "<!-- 12.3 -->", "```VAX 12.3",
        "```", "<b>", "> VAX 12.3",
    ],
)  # fmt: skip
def test_markup_and_program_lines_on_few_lines_of_the_page_bar_identical(typed: str) -> None:
    result = one(SAMPLE.replace("VBX=", f"{typed}\n\nVBX="))
    assert result.verdict is Verdict.IDENTICAL_AS_READ
    assert any(piece.read in typed for piece in result.left_over)


def test_a_comment_on_a_page_of_one_line_bars_identical() -> None:
    line = " ".join(SAMPLE.split())
    assert one(line).verdict is Verdict.IDENTICAL
    commented = line.replace("VBX=", "<!-- 12.3 --> VBX=")
    assert one(commented).verdict is Verdict.IDENTICAL_AS_READ


@pytest.mark.parametrize("markup", ["{}<br>", "<p class='row'>{}</p>", "> {}", "\x1b[32m{}\x1b[0m"])
def test_markup_throughout_the_page_bars_nothing(markup: str) -> None:
    text = "\n".join(markup.format(line) if line.strip() else line for line in SAMPLE.split("\n"))
    assert one(text).verdict is Verdict.IDENTICAL
    assert one(f"<pre>{SAMPLE.replace(' -', ' &minus;')}</pre>").verdict is Verdict.IDENTICAL


@pytest.mark.parametrize("typed", ["<VAX 31.2>", "<should be 31.2>"])
def test_what_stands_in_angle_brackets_and_is_no_element_was_typed(typed: str) -> None:
    result = one(SAMPLE.replace("-13.263", f"-13.263 {typed}"))
    assert result.verdict is Verdict.IDENTICAL_AS_READ


def test_a_dash_in_front_of_one_line_is_no_list() -> None:
    assert one(SAMPLE.replace(" -19.8", "- -19.8")).verdict is Verdict.IDENTICAL_AS_READ
    items = "\n".join(f"- {line.strip()}" if line.strip() else "" for line in SAMPLE.split("\n"))
    assert one(items.replace("- -19.8", "-19.8")).verdict is not Verdict.DIFFERS


# --- marks beside labels, and the words of the prompts --------------------------------------------

PROMPTS = """\
ENTER THE INITIAL VELOCITY COMPONENTS OF MA :Vax,Vay,Wa ?-29.04,0,0

ENTER THE INITIAL VELOCITY COMPONENTS OF MB :Vbx,Vby,Wb ?14.52,25.15,0

"""
TRANSCRIPT = PROMPTS + SAMPLE


@pytest.mark.long
def test_each_mark_that_the_page_lacks_is_told() -> None:
    """In one line, and nothing else is: no number is accused."""
    assert one(TRANSCRIPT).verdict is Verdict.IDENTICAL
    lost = [match.span() for match in re.finditer("[=()%:?]|,(?=V|W)", TRANSCRIPT)]
    assert len(lost) == 36 + 8
    for number, (start, stop) in enumerate(lost):
        mark = TRANSCRIPT[start:stop]
        line = TRANSCRIPT.count("\n", 0, start) + 1
        (shown,) = read_printouts(TRANSCRIPT[:start] + TRANSCRIPT[stop:])
        (label,) = [label for label in shown.labels if label.bears]
        assert (label.printed, label.line, label.kind) == (mark, line, Kind.MISSING)
        if number % 6:
            continue
        result = verify(shown)
        assert result.verdict is Verdict.IDENTICAL_AS_READ, mark
        assert not result.differing
        said = [row.strip() for row in lines(result) if "where the program prints it" in row]
        assert len(said) == 1
        assert said[0].startswith(f"line {line}: no {mark!r} of ")


@pytest.mark.parametrize("word", ["ENTER", "THE", "INITIAL", "VELOCITY", "COMPONENTS", "OF", "MB"])
def test_each_word_that_a_prompt_lacks_is_told(word: str) -> None:
    first, second = TRANSCRIPT.split("\n\n", 1)
    result = one(f"{first}\n\n{second.replace(word, '', 1)}")
    assert result.verdict is Verdict.IDENTICAL_AS_READ
    assert not result.differing
    (said,) = [row for row in lines(result) if "where the program prints" in row]
    assert said.startswith("  line 3: ")
    assert word in said
    assert "prompt" in said


def test_a_lost_percent_sign_is_told_with_its_number_and_in_json() -> None:
    result = one(SAMPLE.replace(" %", ""))
    assert "  line 14: no '%' of LOSS, where the program prints it" in lines(result)
    described = result.as_json()
    assert described["verdict"] == "identical_as_read"
    (mark,) = [label for label in described["labels"] if label["printed"] == "%"]
    assert (mark["name"], mark["kind"], mark["read"]) == ("LOSS", "missing", "")


def test_a_page_retyped_without_any_equals_sign_is_told_once() -> None:
    """As tables are; one sign that is there makes the others missing."""
    page = SAMPLE.replace("=", "")
    result = one(page)
    assert result.verdict is Verdict.IDENTICAL
    assert "retyped in another form: the page has no '='" in result.remarks
    assert not any("where the program prints" in row for row in lines(result))
    result = one(page.replace("VAX", "VAX="))
    assert result.verdict is Verdict.IDENTICAL_AS_READ
    assert "line 1: no '=' of MA, '=' of MB, " in "\n".join(lines(result))
    result = one(page.replace("(", "").replace(" %", ""))
    assert "retyped in another form: the page has no '=', '%', '('" in result.remarks


@pytest.mark.parametrize("read", ["-", "~", "Q"])
def test_a_glyph_that_no_reader_takes_for_the_printed_mark_is_told(read: str) -> None:
    result = one(SAMPLE.replace("MB=", f"MB {read}", 1))
    assert result.verdict is Verdict.IDENTICAL_AS_READ
    assert f"line 1: {read!r} where the program prints '=' of MB" in "\n".join(lines(result))


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("%", "#", "line 14: # for %"),
        ("%", "S", "line 14: S for %"),
        ("MB=", "MB:", "line 1: : for ="),
        ("MB=", "MBS", "line 1: S for ="),
        ("15.91)", "15.91/", "line 18: / for )"),
    ],
)
def test_a_look_alike_of_a_mark_is_the_readers(old: str, new: str, told: str) -> None:
    """Of a page that is shown to be machine-read; on another somebody typed it."""
    text = SAMPLE.replace(old, new, 1)
    result = one(text.replace("INITIAL KE", "1N1T1AL KE"))
    assert result.verdict is Verdict.IDENTICAL
    assert any(told in remark or told.split(": ")[1] in remark for remark in result.remarks)
    result = one(text)
    line, _, mark = told.partition(": ")
    assert result.verdict is Verdict.IDENTICAL_AS_READ
    assert f"{line}: {mark[0]!r} where the program prints {old[-1]!r}" in "\n".join(lines(result))


@pytest.mark.parametrize("read", ["X", "°/o", "o/o", "percent", "%%"])
def test_whatever_stands_for_the_percent_sign_accuses_no_number(read: str) -> None:
    result = one(SAMPLE.replace("%", read))
    assert result.verdict is Verdict.IDENTICAL_AS_READ
    assert not result.differing
    assert any("line 14" in row for row in lines(result))


def test_a_heading_that_the_page_lacks_is_told_in_one_line() -> None:
    result = one(SAMPLE.replace(f" {HEADING}\n", ""))
    assert result.verdict is Verdict.IDENTICAL_AS_READ
    said = "line 5: no labels before the numbers where the program prints PA, PB, TA, TB, GA"
    assert [row.strip() for row in lines(result)].count(said) == 1


@pytest.mark.parametrize("heading", [f"{HEADING} (DEG)", "PA(DEG) PB TA TB GA"])
def test_units_in_the_heading_are_told_and_accuse_nothing(heading: str) -> None:
    result = one(SAMPLE.replace(HEADING, heading))
    assert result.verdict is Verdict.IDENTICAL_AS_READ
    assert "left over" in "\n".join(lines(result))


@pytest.mark.parametrize(
    ("page", "told", "bars"),
    [
        (SAMPLE.replace("*****", "****", 1), "4 of 5 above the final velocities", True),
        (SAMPLE.replace("*****\n\n", "", 1), "0 of 5 above the final velocities", True),
        (SAMPLE.rstrip("*\n"), "0 of 5 below them", True),
        (
            SAMPLE.replace("*****\n\n", "", 1).rstrip("*\n"),
            "0 of 5 above the final velocities, 0 of 5 below them",
            False,
        ),
        (
            SAMPLE.replace("*****", "***"),
            "3 of 5 above the final velocities, 3 of 5 below them",
            True,
        ),
    ],
)
def test_asterisks_that_the_page_lacks_are_counted(page: str, told: str, bars: bool) -> None:
    """Readers lose them on pages that are exact otherwise, and books leave both rows out."""
    result = one(page)
    assert result.verdict is (Verdict.IDENTICAL_AS_READ if bars else Verdict.IDENTICAL)
    assert one(page.replace("INITIAL KE", "1N1T1AL KE")).verdict is Verdict.IDENTICAL
    assert f"asterisks read: {told}" in result.remarks
    assert not any("asterisks" in remark for remark in one(SAMPLE).remarks)
