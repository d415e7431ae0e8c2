"""``impact88 basic``: the prompt, program files, LOAD and SAVE, control-C, exit statuses."""

from __future__ import annotations

import os
import select
import signal
import subprocess
import sys
import time
from contextlib import suppress

import pytest
from installed import COMMAND, impact88

from impact88.collision.casescene import sample
from impact88.files import packaged_text
from impact88.program.run import run

REPLIES = "-29.04,0,0\n14.52,25.15,0\n"


@pytest.fixture
def program(tmp_path):
    """Write a program file; returns its path."""

    def write(text: str, name: str = "test.bas") -> str:
        path = tmp_path / name
        path.write_text(text)
        return str(path)

    return write


def test_the_listing_is_loaded_and_runs():
    done = impact88("basic", input="RUN\n" + REPLIES)
    assert (done.returncode, done.stderr) == (0, "")
    shown = done.stdout.removeprefix("\n]RUN\n")
    # comma zones do not occur in it, so the printout is the port's
    assert shown.removesuffix("\n]\n") == run(sample(1)).page


def test_retype_a_line_and_run():
    lines = sample(1).replaced({"MU": ".5"}).typed_lines()
    done = impact88("basic", input="\n".join([*lines, "RUN", REPLIES]))
    assert run(sample(1).replaced({"MU": ".5"})).page in done.stdout


def test_list_shows_the_line_as_the_rom_does():
    done = impact88("basic", input="LIST 350\n")
    assert "350 N = 6:M = 6: REM  SETTING M =\n      4 WILL" in done.stdout


def test_a_file_runs_and_leaves(program):
    done = impact88("basic", program('10 PRINT "Hello"\n20 END\n30 PRINT "NO"\n'))
    assert (done.returncode, done.stdout, done.stderr) == (0, "Hello\n", "")


def test_a_file_with_input(program):
    path = program("10 INPUT A,B\n20 PRINT A*B")
    assert impact88("basic", path, input="6,7\n").stdout == "?6,7\n42\n"
    assert impact88("basic", path, "--raw", input="6,7\n").stdout == "?\x006,7\n42\n"
    done = impact88("basic", path, input="6\n")
    assert done.returncode == 2
    assert done.stderr.startswith("impact88 basic: the input ended")
    assert done.stderr.count("\n") == 1


def test_the_published_program_as_a_file(program):
    path = program(packaged_text("impact88.legacy", "impact.bas"))
    done = impact88("basic", path, input=REPLIES)
    assert done.stdout == run(sample(1)).page
    assert impact88("basic", path, "--raw", input=REPLIES).stdout == run(sample(1)).printout
    assert impact88("basic", path, "--no-dos", "--raw", input=REPLIES).stdout == (
        run(sample(1), dos=False).printout
    )


def test_an_error_is_status_1(program):
    done = impact88("basic", program("10 PRINT 1/0"))
    assert done.returncode == 1
    assert done.stdout == "\n?DIVISION BY ZERO ERROR IN 10\n"


def test_prompt_stays(program):
    done = impact88("basic", program("10 A=5:PRINT 1/0"), "--prompt", input="PRINT A\n")
    assert done.returncode == 0
    assert done.stdout.endswith("IN 10\n]PRINT A\n5\n\n]\n")


def test_max_statements(program):
    done = impact88("basic", program("10 N=N+1:GOTO 10"), "--max-statements", "5000")
    assert done.returncode == 1
    assert done.stderr == "impact88 basic: stopped after 5000 statements\n"
    assert impact88("basic", "--max-statements", "0").returncode == 2


def test_printer(program, tmp_path):
    out = tmp_path / "paper.txt"
    path = program(
        '10 PRINT CHR$(4);"PR#1"\n20 PRINT "PAPER"\n30 PRINT CHR$(4)"PR#0"\n40 PRINT "GLASS"'
    )
    assert impact88("basic", path, "--printer", str(out)).stdout == "GLASS\n"
    assert out.read_text() == "PAPER\n"


def test_load_and_save(program, tmp_path):
    path = program('10 print "mixed Case":rem\n20 REM  as  It is\n25 data low\n')
    other = tmp_path / "Other.bas"
    done = impact88("basic", input=f"LOAD {path}\n30 PRINT 3\nSAVE {other}\nLIST 20\n")
    assert done.stderr == f"impact88 basic: {other}: saved, 4 lines\n"
    assert "20  REM   as  It is" in done.stdout
    saved = '10 PRINT "mixed Case": REM\n20 REM  as  It is\n25 DATA LOW\n30 PRINT 3\n'
    assert other.read_text() == saved
    done = impact88("basic", input=f"LOAD {tmp_path / 'none'}\nPRINT 5\n")
    assert "cannot be read" in done.stderr
    assert "5\n" in done.stdout


def test_save_writes_over_no_file_but_its_own(program, tmp_path):
    letter = tmp_path / "letter.txt"
    letter.write_text("Dear Sir\n")
    done = impact88("basic", input=f'NEW\n10 PRINT 1\nSAVE "{letter}"\n')
    assert letter.read_text() == "Dear Sir\n"
    assert "letter.txt: was neither loaded nor saved in this session" in done.stderr
    mine = tmp_path / "mine.bas"
    impact88("basic", input=f'NEW\n10 PRINT 1\nSAVE "{mine}"\n20 PRINT 2\nSAVE {mine}\n')
    assert mine.read_text() == "10 PRINT 1\n20 PRINT 2\n"
    impact88("basic", input=f"LOAD {mine}\n30 END\nSAVE {mine}\n")
    assert mine.read_text().endswith("30 END\n")
    path = program("10 PRINT 1\n")
    impact88("basic", path, "--prompt", input=f"20 END\nSAVE {path}\n")
    assert os.path.getsize(path) > len("10 PRINT 1\n")


@pytest.mark.parametrize("word", ["SAVE", "LOAD"])
def test_a_file_needs_a_name(word):
    done = impact88("basic", input=f"{word}\n")
    assert done.stderr == f"impact88 basic: {word} needs a file's name: {word} mine.bas\n"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("PRINT 1\n", "row 1 has no line number"),
        ("64000 PRINT\n", "63999"),
        ("\n".join(f"{n} REM {'X' * 200}" for n in range(300)), "does not fit into 48K"),
    ],
)
def test_what_is_no_program(program, text, words):
    done = impact88("basic", program(text))
    assert done.returncode == 2
    assert words in done.stderr
    assert done.stderr.count("\n") == 1


def test_a_long_line_survives_save_new_load(tmp_path):
    line = "10 " + "GOSUB9:" * 33 + "END"
    path = tmp_path / "long.bas"
    done = impact88("basic", input=f"{line}\nSAVE {path}\nNEW\nLOAD {path}\nLIST 10\n")
    assert "text cannot hold" not in done.stderr
    assert len(path.read_text()) > 300
    assert "".join(done.stdout.partition("LIST")[2].split()).count("GOSUB9") == 33


def test_a_program_is_no_scene(program):
    done = impact88("run", program("10 PRINT 1\n"))
    assert done.returncode == 2
    assert "impact88 basic runs it" in done.stderr


def test_a_missing_file_and_prompt_without_one():
    assert impact88("basic", "no-such.bas").returncode == 2
    assert impact88("basic", "--prompt").returncode == 2


def test_what_is_not_done_is_said(program):
    done = impact88("basic", program("10 HGR\n"))
    assert (done.returncode, done.stdout) == (1, "\n?SYNTAX ERROR IN 10\n")
    assert done.stderr == "impact88 basic: HGR is not supported: text only, no machine code\n"


def test_what_is_passed_over_is_said_however_the_program_ends(program):
    text = '10 PRINT CHR$(4);"READ IN":INPUT A$:PRINT A$'
    said = "impact88 basic: the disk command READ was passed over: there is no disk\n"
    done = impact88("basic", program(text), input="TYPED\n")
    assert (done.returncode, done.stdout, done.stderr) == (0, "?TYPED\nTYPED\n", said)
    done = impact88("basic", program(text))
    assert done.returncode == 2
    assert done.stderr.startswith(said)
    done = impact88("basic", program(f"{text}:GOTO 10"), "--max-statements", "3", input="A\n")
    assert said in done.stderr


def test_control_c_breaks_a_program(program):
    process = subprocess.Popen(
        [COMMAND, "basic", program('20 PRINT MID$("ON"+CHR$(13),1+3*(N>0));:N=1:GOTO 20')],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        env={**os.environ, "PYTHONUNBUFFERED": "1"},
        encoding="utf-8",
    )
    assert process.stdout.readline() == "ON\n"
    process.send_signal(signal.SIGINT)
    shown, complaints = process.communicate(timeout=100)
    assert (shown, complaints) == ("\nBREAK IN 20\n", "")
    assert process.returncode == 130


@pytest.mark.skipif(sys.platform == "win32", reason="needs a pseudo-terminal")
def test_on_a_terminal(program):
    import pty

    leader, follower = pty.openpty()
    process = subprocess.Popen(
        [COMMAND, "basic"], stdin=follower, stdout=follower, stderr=follower, close_fds=True
    )
    os.close(follower)

    def wait_for(text: str) -> None:
        seen = ""
        limit = time.monotonic() + 100
        while text not in seen and time.monotonic() < limit:
            if select.select([leader], [], [], 0.2)[0]:
                seen += os.read(leader, 4096).decode()
        assert text in seen

    wait_for("control-D leaves.\r\n\r\n]")
    os.write(leader, b"print 6*7\r")
    wait_for("\n42")
    os.write(leader, b"10 ?5:goto 10\rrun\r")
    wait_for("5\r\n5\r\n")
    process.send_signal(signal.SIGINT)
    wait_for("BREAK\a IN 10\r\n]\r]")
    os.write(leader, b"\x04")
    try:
        limit = time.monotonic() + 100
        while process.poll() is None and time.monotonic() < limit:
            if select.select([leader], [], [], 0.1)[0]:
                with suppress(OSError):  # the other side has closed
                    os.read(leader, 4096)
        assert process.returncode == 0
    finally:
        process.kill()
        os.close(leader)
