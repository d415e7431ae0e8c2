"""Programs as paper and disks hold them: what LIST prints loads again, whatever ends its rows."""

from __future__ import annotations

import os
import re
import string
from collections.abc import Callable
from pathlib import Path
from typing import Any

import captures
import pytest
from commands import command, shell
from emulation import FUZZ, PROGRAMS
from hypothesis import example, given
from hypothesis import strategies as st
from longer import long_but

from impact88.apple.emulator.emulator import Applesoft
from impact88.apple.emulator.programfile import SCREEN_WIDTH, read_program
from impact88.apple.emulator.tokens import KEYWORDS
from impact88.errors import UserError
from impact88.program.copies import ListingCopy
from impact88.program.run import run
from impact88.program.scene import sample

LISTING = (captures.ROOT / "legacy" / "impact.bas").read_text(encoding="ascii")
TEXTS = {path.stem: captures.printed(path.read_bytes()) for path in PROGRAMS}
TEXTS |= {case["name"]: case["program"] for case in FUZZ}
HARD = (
    "broad_0762",  # a keyword that crosses the screen's edge: LIST counts columns anew
    "fuzz_open_0111",
    "goto_computed",  # its saved text could be one long line of LIST's
    "misc_clear",  # DATA with a blank, and no line begins with a keyword
    "print_question_mark",
    "keys_034",  # a row that begins with a number and a colon
)


def machine_with(program: str, *, small: bool = False) -> Applesoft:
    """A machine in which a program has been typed; ``small``: with its small letters."""
    machine = Applesoft()
    for line in filter(None, program.split("\n")):
        (machine.enter if small else machine.type_line)(line)
    machine.type_line("TEXT")
    machine.take_output()
    return machine


def sent(machine: Applesoft) -> str:
    """Return what LIST sends to a file."""
    machine.take_output()
    machine.machine.poke(33, 40)
    machine.enter("LIST")
    return machine.take_output()


def on_screen(machine: Applesoft) -> str:
    """LIST's rows on a screen, line by line, so that none scrolls away."""
    text = ""
    for number, _ in machine.machine.lines():
        machine.machine.poke(33, SCREEN_WIDTH)
        machine.enter("HOME")
        machine.enter(f"LIST {number}")
        text += machine.screen_text()
    return text


def image(machine: Applesoft) -> bytes:
    """The program as it lies in memory."""
    return bytes(machine.machine.ram[0x801 : machine.machine.prgend])


def lines_of(machine: Applesoft) -> list[tuple[int, bytes]]:
    return list(machine.machine.lines())


@pytest.mark.captures
@pytest.mark.parametrize(
    "form",
    long_but(
        [
            sent,
            lambda machine: re.sub(" +\n", "\n", sent(machine)),
            on_screen,
            Applesoft.source,
            image,
            lambda machine: len(image(machine)).to_bytes(2, "little") + image(machine) + bytes(99),
        ],
        kept=range(3, 6),
    ),
    ids=["sent", "stripped", "screen", "saved", "tokenised", "DOS 3.3"],
)
def test_every_captured_program_loads_as_it_was(form: Any) -> None:
    names = [*TEXTS][:: 1 if "IMPACT88_CAPTURES" in os.environ else 8]
    for name in (*names, *filter(TEXTS.get, HARD)):
        machine = machine_with(TEXTS[name])
        lines = lines_of(machine)
        # blanks at the end of a line are on no screen
        is_visible = not any(tokens.endswith(b" ") for _, tokens in lines)
        # LIST 0 shows all lines
        if lines and is_visible and lines[0][0]:
            assert read_program(form(machine)) == lines, name


def test_the_listing_loads_as_listed() -> None:
    machine = machine_with(LISTING, small=True)
    lines = lines_of(machine)
    assert read_program(sent(machine)) == lines
    assert read_program(on_screen(machine)) == lines
    assert read_program("".join(f"    {row}\n" for row in sent(machine).split("\n"))) == lines


STATEMENTS = st.text(
    st.sampled_from([*string.ascii_uppercase, *string.digits, *'  "":;,()$%.=+-*/<>?']), max_size=30
) | st.sampled_from([f"{word} " for word in KEYWORDS])


@example({0: ['"', " "]})
@example({0: ['"'], 1: ["<"]})
@example({0: [":"], 1: ["<"]})
@example({1000: ["END", "0" * 26, '"000 ']})
@given(st.dictionaries(st.integers(0, 63999), st.lists(STATEMENTS, max_size=6), max_size=8))
def test_what_a_person_may_type_loads_as_it_was(program: dict[int, list[str]]) -> None:
    """LIST sends it, SAVE writes it, a disk has its tokens."""
    text = "".join(f"{number} {''.join(parts)}\n" for number, parts in program.items())
    machine = machine_with(text[:4000])
    lines = lines_of(machine)
    assert not lines or read_program(image(machine)) == lines
    # rows as wide as a device's, and a line that no statement begins: it may go on the row before
    wide = max(map(len, f"{machine.source()}\n{sent(machine)}".split("\n"))) >= 33
    if wide and not all(tokens[:1].isalpha() or 0x80 <= tokens[0] <= 0xBF for _, tokens in lines):
        return
    # DATA or REM inside a statement, which no program has: the blank behind it may be LIST's
    if any(re.search(rb"[^:][\x83\xb2]", tokens) for _, tokens in lines):
        return
    # rows of just a screen's width are a saved screen: blanks at their ends fill it
    screen = {len(row) for row in machine.source().split("\n") if row.strip()} == {SCREEN_WIDTH}
    if not (screen and any(tokens.endswith(b" ") for _, tokens in lines)):
        assert read_program(machine.source()) == lines
    if not any(tokens.endswith(b" ") for _, tokens in lines):  # they may fill a row, and none shows
        assert read_program(sent(machine)) == lines


def test_only_what_has_no_other_reading_is_listed() -> None:
    """The blank after REM and DATA is LIST's in a listing and the text's elsewhere."""
    assert read_program("10  REM X") == [(10, b"\xb2X")]
    assert read_program("10 REM X") == [(10, b"\xb2 X")]
    assert read_program("10  REM X\n20 PRINT")[0] == (10, b"\xb2 X")


@pytest.mark.parametrize(
    ("text", "lines"),
    [
        ("30 PRINT 1\n20 PRINT 2\n30 PRINT 3", [20, 30]),  # as typed, the last one stays
        ("  10 PRINT 1\n 200 PRINT 2\n1000 PRINT 3", [10, 200, 1000]),
        ("]LIST\n\n10  END \n\n]", [10]),
        ("\f10 PRINT A\n20 END\f\x1a", [10, 20]),
        ("", []),
    ],
)
def test_where_lines_begin(text: str, lines: list[int]) -> None:
    assert [number for number, _ in read_program(text)] == lines


@pytest.mark.parametrize(
    ("program", "words"),
    [
        ("10 A\n20\tPRINT", "row 2, column 3: a tab"),
        ('10 A\n20 PRINT "\xe9"', "row 2, column 11: character 'é'"),
        ("10 PRINT 2 \u2212 1".encode(), "row 1, column 12: character '−'"),
        (b'10 PRINT "\xe9"', r"row 1, column 11: character \$E9"),
        ("10 PRINT 1\nPRINT 2", "row 2 has no line number"),
        ("10 A = 1\n     20 + B", "row 2 has no line number"),
        ('10  PRINT "' + "A" * 40 + '\nB"', "row 2 has no line number"),  # cut by the paper
        (b"\1\2\0\0\0\0\3", "no tokenised Applesoft program"),
        (b"\x10\x08\x0a\x00\0\x00\x01", "no tokenised Applesoft program"),
        ("10 PRINT".encode("utf-16-be"), "no tokenised Applesoft program"),
        (5, "not int"),
        (None, "not NoneType"),
    ],
)
def test_what_is_no_program_is_refused_by_its_place(program: Any, words: str) -> None:
    machine = Applesoft()
    machine.load("10 PRINT 1")
    with pytest.raises(UserError, match=words):
        machine.load(program)
    assert machine.source() == "10 PRINT 1\n"


ROWS = st.lists(
    st.tuples(st.sampled_from(["", "7", "20 ", " 30", "63999 ", "64000 "]), STATEMENTS), max_size=12
)


@example([("20 ", "")])
@example([("", "10 STOP:POP"), ("20 ", ""), ("", "40 ASC%B.N%(I)")])
@given(ROWS)
def test_any_rows_are_a_program_or_refused_by_a_row(rows: list[tuple[str, str]]) -> None:
    text = "\n".join(map("".join, rows))
    words = ""
    try:
        lines = read_program(text)
    except UserError as error:
        lines, words = [], str(error)
    assert not words or re.search("row [0-9]+", words)
    assert all(0 <= number <= 63999 and tokens for number, tokens in lines)


def test_apples_text_files_have_high_bits() -> None:
    text = "10 PRINT 1\r20 END\r"
    assert read_program(bytes(ord(c) | 0x80 for c in text) + bytes(9)) == read_program(text)
    assert read_program(text.encode() + bytes(9)) == read_program(text)
    assert read_program(text.encode("utf-16")) == read_program(text)
    assert read_program(text.encode("utf-8-sig")) == read_program(text)


def test_a_tokenised_file_keeps_its_order_and_leaves_out_what_follows() -> None:
    machine = machine_with("10 A=1\n20 B=2")
    data = image(machine)
    assert read_program(data + b"\x60\x60") == read_program(data)  # machine code behind it
    disorder = data.replace(b"\x0a\0A", b"\x1e\0A")  # 30 before 20, as no one can type
    machine.load(disorder)
    assert [number for number, _ in lines_of(machine)] == [30, 20]
    elsewhere = bytearray(data)
    elsewhere[1] = elsewhere[9] = 0x40  # saved from $4001 on
    assert read_program(bytes(elsewhere)) == lines_of(machine_with("10 A=1\n20 B=2"))


@pytest.mark.parametrize(
    "change",
    [
        lambda data: data[:-2],
        lambda data: data[:-1],
        lambda data: data[:-2] + b"\xff\0\1",
        lambda data: data.replace(b"\x09\x08", b"\x99\x66"),
        lambda data: data[:-3],
    ],
    ids=["no zeros", "one zero", "FF 00 01", "a wrong link", "cut in the last line's zero"],
)
@pytest.mark.parametrize("dos", [False, True])
def test_a_tokenised_program_is_walked_as_the_rom_does(
    change: Callable[[bytes], bytes], dos: bool
) -> None:
    """It makes the links anew, and stops at a zero high byte alone; nothing follows the file."""
    text = "10 A=1\n20 B=A+2\n30 PRINT B"
    data = change(image(machine_with(text)))
    lines = read_program(len(data).to_bytes(2, "little") + data if dos else data)
    assert lines == lines_of(machine_with(text))
    machine = Applesoft()
    machine.load(data)
    machine.type_line("RUN")
    assert machine.take_output() == "3\n"


def test_a_wrong_link_is_made_anew_by_the_next_line_typed() -> None:
    """The search for a line's end begins at its second token."""
    machine = machine_with("10 A=1\n20 PRINT A")
    machine.type_line("POKE 2053,0:POKE 2049,0")
    machine.type_line("30 END")
    assert machine.machine.word(0x801) == machine.machine.ram.index(0, 0x806) + 1


def test_basic_and_verify_load_the_same(tmp_path: Path) -> None:
    machine = machine_with(LISTING, small=True)
    forms: dict[str, str | bytes] = {"listed.bas": sent(machine), "disk.bas": image(machine)}
    for name, form in forms.items():
        path = tmp_path / name
        path.write_bytes(form if isinstance(form, bytes) else form.encode())
        assert ListingCopy(str(path)).run(sample(1)).page == run(sample(1)).page
        result = command("basic", input=f"LOAD {path}\nLIST\n")
        listing = result.out[result.out.rindex("]LIST") :]
        assert read_program(listing) == lines_of(machine)


def test_save_writes_no_file(tmp_path: Path) -> None:
    session_file = tmp_path / "rr.txt"
    session_file.write_text(f"10 PRINT 1\nSAVE {session_file}\nPRINT 6*7\n")
    result = shell(f"impact88 basic < {session_file}")
    assert session_file.read_text() == f"10 PRINT 1\nSAVE {session_file}\nPRINT 6*7\n"
    assert "42\n" in result.out
    assert "?SYNTAX ERROR" in result.out
