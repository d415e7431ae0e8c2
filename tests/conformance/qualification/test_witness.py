"""The ROM as witness: on a small ROM of our own, and on the real one where IMPACT88_ROM names it.

A full hearing takes minutes: IMPACT88_WITNESS says how many captures and how many fresh scenes the
real ROM is asked for, 3 unless set.
"""

from __future__ import annotations

import gzip
import json
import os

import captures
import pytest
from installed import impact88
from tinyrom import CODE, START, rom

from impact88.apple.captured import result
from impact88.collision.casescene import sample
from impact88.conformance.qualification.witness.apple import APPLE_II_PLUS, Apple, Lost, read_image
from impact88.conformance.qualification.witness.hearing import (
    WitnessCase,
    cases,
    hear,
    hear_sample,
    hear_scene,
    own_programs,
)
from impact88.conformance.qualification.witness.session import Session, small_letters
from impact88.errors import UserError
from impact88.program.scene import LISTING
from impact88.program.run import run

pytest.importorskip("py65")

RUN1 = run(sample(1), dos=False)
ROM = os.environ.get("IMPACT88_ROM")


@pytest.fixture(scope="module")
def played() -> bytes:
    """A ROM that plays the first published run back."""
    return rom(RUN1.printout, RUN1.reals, RUN1.A)


@pytest.fixture(scope="module")
def session(played: bytes) -> Session:
    return Session(played)


def differing(heard) -> set[str]:
    return {f"{one.who}: {one.what}" for one in heard.differences}


# --- the machine -----------------------------------------------------------------------------


def test_a_run_is_taken_down_to_the_bit(session: Session) -> None:
    found = session.run_scene(sample(1))
    assert found == {"printout": RUN1.printout, "reals": RUN1.reals, "A": RUN1.A}


def test_the_listing_is_typed_with_its_small_letters(session: Session) -> None:
    session.run_scene(sample(1))
    session.apple.restore(session.with_listing)
    text, place = (captures.ROOT / "legacy" / LISTING).read_text(encoding="ascii"), 0
    for line in text.splitlines():
        place = session.apple.memory.index(line.partition(" ")[2].encode("ascii") + b"\0", place)
    assert small_letters(session.apple, "120 REM NONE") == []
    with pytest.raises(ValueError, match="does not hold ' Another program'"):
        small_letters(session.apple, "120 REM Another program")


def test_a_key_is_pressed_only_when_the_rom_waits(session: Session) -> None:
    session.apple.restore(session.fresh)
    session.apple.type_keys("10 REM\n20 rem")
    assert session.apple.take_output() == "10 REM\n\n]20 REM"
    assert not session.apple.memory.keys


def test_skipped_columns_come_out_as_blanks_where_asked() -> None:
    text = "A\x7f\x7fB\n\x7f\nC\x7f\x07D\n"
    machine = Session(rom(text, {}, None))
    assert machine.run_program("10 REM") == "A  B\n\nC\x07 D\n"
    assert machine.run_program("10 REM", blanks=False) == "AB\n\nC\x07D\n"


def test_rom_cannot_be_written(played: bytes) -> None:
    apple = Apple(played)
    apple.boot()
    before = bytes(apple.memory[START:0x10000])
    for address in (START, 0xC000, 0xFFFF):
        apple.memory[address] = 0x55
    assert bytes(apple.memory[START:0x10000]) == before == played
    apple.memory[0xBFFF] = 0x55
    assert apple.memory[0xBFFF] == 0x55


def test_a_rom_that_comes_to_no_prompt_says_so(played: bytes) -> None:
    with pytest.raises(Lost, match="does not wait for a key"):
        Apple(bytes(len(played))).boot(limit=2000)
    at = played.index(b"\xa9\xdd")  # LDA #"]"
    for prompt, says in (("*", "monitor"), (">", "Integer BASIC"), ("!", "no prompt of Applesoft")):
        other = played[: at + 1] + bytes([ord(prompt) | 0x80]) + played[at + 2 :]
        with pytest.raises(UserError, match=says):
            Session(other)


# --- comparing -------------------------------------------------------------------------------


def test_a_published_run_without_a_difference(session: Session) -> None:
    heard = hear_sample(session, 1)
    assert heard.differences == []
    assert heard.compared == ("port", "emulator", "replay", "published")


def test_one_digit_of_the_rom_differs_from_all() -> None:
    text = RUN1.printout.replace("57.47", "57.48")
    heard = hear_sample(Session(rom(text, RUN1.reals, RUN1.A)), 1)
    assert differing(heard) == {
        "port: printout",
        "emulator: printout",
        "published: printout",
        "replay: LOSS",
    }
    shown = "\n".join(line for one in heard.differences for line in one.lines())
    assert "-INITIAL KE= 100904.929 KE LOSS= 57.48 %" in shown
    assert "+INITIAL KE= 100904.929 KE LOSS= 57.47 %" in shown


@pytest.mark.long
def test_one_bit_of_a_variable_or_of_the_array_differs() -> None:
    changed = f"{int(RUN1.reals['D1'], 16) ^ 1:010x}"
    data = list(RUN1.A["data"])
    data[8] = "8100000001"
    machine = Session(rom(RUN1.printout, {**RUN1.reals, "D1": changed}, {**RUN1.A, "data": data}))
    heard = hear_scene(machine, "x", sample(1))
    assert differing(heard) == {"port: D1", "emulator: D1", "port: A(1,1)", "emulator: A(1,1)"}
    reals = {name: value for name, value in RUN1.reals.items() if name != "KF"}
    heard = hear_scene(Session(rom(RUN1.printout, reals, None)), "x", sample(1))
    assert {"port: KF", "port: DIM A"} <= differing(heard)


def test_a_capture_is_compared_too(session: Session) -> None:
    row = {"scene": dict(sample(1)), **RUN1._asdict()}
    assert hear(session, WitnessCase("scenes", "x", row)).differences == []
    row["reals"] = {**RUN1.reals, "XA": "00" * 5}
    assert differing(hear(session, WitnessCase("scenes", "x", row))) == {"capture: XA"}


def test_programs_and_calculations_are_compared() -> None:
    machine = Session(rom("HELLO\n", {}, None))
    program = {"bas": '10 PRINT "HELLO"', "in": "", "out": "HELLO\n"}
    assert hear(machine, WitnessCase("fuzz", "x", program)).differences == []
    program["out"] = "HELLO!\n"
    assert differing(hear(machine, WitnessCase("fuzz", "x", program))) == {"capture: displayed"}
    for row in (
        ["neg", "8490000001", "", "20", "8410000001:849000000100:20"],
        ["div", "8490000000", "0000000000", "00", "E133"],
        ["cmp", "8400000000", "8500000000", "00", "01"],
        ["fout", "822df85474", "", "00", "2.718282"],
    ):
        heard = hear(machine, WitnessCase("arithmetic", row[0], row))
        assert differing(heard) <= {f"this arithmetic: {' '.join(filter(None, row[:4]))}"}
        assert result(heard.capture[4]) == result(row[4])
    row = ["neg", "8490000001", "", "20", "8410000000:849000000000:20"]
    assert len(hear(machine, WitnessCase("arithmetic", "neg", row)).differences) == 1


def test_a_folder_of_programs(tmp_path, played: bytes) -> None:
    path, folder, saved = tmp_path / "own.rom", tmp_path / "programs", tmp_path / "saved"
    path.write_bytes(rom("HELLO\n", {}, None))
    folder.mkdir()
    options = ("--rom", str(path), "--any-rom", "--programs", str(folder), "--save", str(saved))
    done = impact88("witness", *options)
    assert (done.returncode, done.stderr.count("\n")) == (2, 1)
    assert "holds no .bas" in done.stderr
    (folder / "same.bas").write_bytes(b'10 PRINT "HELLO"\r\n')
    heard = hear(Session(path.read_bytes()), own_programs(str(folder))[0])
    assert {one.what for one in heard.differences} <= {"screen"}  # the small ROM draws none
    (folder / "other.BAS").write_text("10 INPUT A$:PRINT A$\n")
    (folder / "other.in").write_text("HI\n")
    done = impact88("witness", *options)
    assert done.returncode == 1
    assert "+?HI" in done.stdout
    assert "own programs, emulator" in done.stdout
    assert (saved / "programs" / "same.out").read_text() == "HELLO\n"
    (folder / "loop.bas").write_text("10 GOTO 10\n")
    (folder / "other.BAS").write_text(f"10 REM {'X' * 240}\n")
    assert "row 1 has 247 characters" in impact88("witness", *options).stderr


@pytest.mark.long
def test_captures_are_drawn_without_repeating() -> None:
    drawn = cases(60, seed=1)
    assert len({(case.kind, case.name) for case in drawn}) == 60
    assert {case.kind for case in drawn} == {"scenes", "programs", "fuzz", "arithmetic"}
    assert drawn == cases(60, seed=1) != cases(60, seed=2)
    operations = {case.data[0] for case in drawn if case.kind == "arithmetic"}
    assert len(operations) == 19


# --- the command -----------------------------------------------------------------------------


@pytest.mark.long
def test_command_and_what_it_saves(tmp_path, played: bytes) -> None:
    path, again = tmp_path / "own.rom", tmp_path / "again"
    path.write_bytes(played)
    options = ("--rom", str(path), "--sample", "1", "--save", str(again))
    done = impact88("witness", *options)
    assert (done.returncode, done.stderr.count("\n")) == (2, 1)
    assert "--any-rom" in done.stderr
    done = impact88("witness", *options, "--any-rom", "--json")
    assert done.returncode == 0, done.stderr
    record = json.loads(done.stdout)
    assert record["passed"]
    assert record["comparisons"]["scenes, published"] == {"total": 1, "right": 1}
    (row,) = map(json.loads, gzip.decompress((again / "scenes.jsonl.gz").read_bytes()).splitlines())
    golden = next(captures.jsonl("scenes"))
    assert set(row) == set(golden)
    assert (row["reals"], row["A"], row["printout"]) == (RUN1.reals, RUN1.A, RUN1.printout)
    path.write_bytes(played.replace(b"57.47", b"57.48"))
    done = impact88("witness", *options, "--any-rom")
    assert done.returncode == 1
    assert "+INITIAL KE= 100904.929 KE LOSS= 57.47 %" in done.stdout


@pytest.mark.parametrize(
    ("size", "says"), [(16384, "IIe"), (12289, "expected"), (2048, "one chip"), (0, "0 bytes")]
)
def test_an_image_of_another_size_gets_one_line(tmp_path, size: int, says: str) -> None:
    path = tmp_path / "x.rom"
    path.write_bytes(bytes(size))
    with pytest.raises(UserError, match=says):
        read_image(str(path), any_rom=True)


def test_the_prompt_is_where_the_program_says(played: bytes) -> None:
    """The small ROM is assembled as meant: its reset vector leads to its code."""
    assert int.from_bytes(played[0xFFFC - START : 0xFFFE - START], "little") == CODE


# --- the real ROM ----------------------------------------------------------------------------


@pytest.mark.skipif(not ROM, reason="IMPACT88_ROM names no Apple II Plus ROM")
def test_the_real_rom_says_the_same() -> None:
    assert read_image(str(ROM)).sha1 == APPLE_II_PLUS
    count = os.environ.get("IMPACT88_WITNESS", "3")
    options = ("--rom", str(ROM), "--captures", count, "--random", count)
    for asked in ((), options[2:]):
        done = impact88("witness", *options[:2], *asked, timeout=3600)
        assert done.returncode == 0, done.stdout + done.stderr
