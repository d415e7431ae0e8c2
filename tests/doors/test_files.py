"""Nothing of the user's is lost: what is written is whole, and replaces only what it should."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from installed import COMMAND, impact88
from longer import long_but

from impact88.collision.casescene import sample
from impact88.errors import LONGEST_MESSAGE, UserError, one_line, quoted
from impact88.files import check_apart, packaged_text, read_bytes, replacing
from impact88.interface.commands.cli import main
from impact88.names import SCENE

ROWS = ",".join(SCENE) + "\n" + ",".join(sample(1)[name] for name in SCENE) + "\n"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "t.csv").write_text(ROWS, "utf-8")
    return tmp_path


def names(folder: Path) -> set[str]:
    return {path.name for path in folder.iterdir()}


# --- messages ------------------------------------------------------------------------------------


def test_a_message_is_one_bounded_line_that_a_terminal_does_not_act_on() -> None:
    text = "\x1b[2J\r\n\x9b\u202e" + "x" * 10_000 + "\ud800 expected a number"
    line = one_line(text)
    assert line.isprintable()
    assert len(line) <= LONGEST_MESSAGE
    assert line.startswith(r"\x1b[2J\r\n\x9b\u202e")
    assert line.endswith("expected a number")
    assert one_line("plain é µ") == "plain é µ"
    assert len(quoted("9" * 10_000_000)) <= 60
    assert str(UserError("is \a", "\x1b.csv")) == r"\x1b.csv: is \x07"


def test_many_escapes_do_not_outgrow_the_bound() -> None:
    assert len(one_line("\x1b" * 499)) <= LONGEST_MESSAGE


# --- one file under two names --------------------------------------------------------------------


@pytest.mark.parametrize("link", [os.symlink, os.link])
@pytest.mark.parametrize(
    "line",
    [
        "solve t.csv -o other",
        "solve t.csv -o o.csv --errors other",
        "verify t.csv --report other",
        "run t.csv --printer other",
        "basic t.csv --printer other",
        "oracle t.csv -o other",
        "compare t.csv -o other",
        "figure scene t.csv -o other.svg",
    ],
)
def test_an_input_is_not_replaced(folder: Path, line: str, link: Callable[..., None]) -> None:
    other = line.split()[-1]
    link("t.csv", other)
    done = impact88(*line.split(), "--to", "csv") if "solve" in line else impact88(*line.split())
    assert done.returncode == 2
    assert "names a file that is read; expected another name" in done.stderr
    assert (folder / "t.csv").read_text("utf-8") == ROWS
    assert names(folder) == {"t.csv", other}


def test_standard_input_is_an_input_too(folder: Path) -> None:
    with open("t.csv", encoding="utf-8") as stdin:
        done = subprocess.run([COMMAND, *"solve - -o t.csv".split()], stdin=stdin, check=False)
    assert done.returncode == 2
    assert (folder / "t.csv").read_text("utf-8") == ROWS


def test_two_outputs_are_two_files(folder: Path) -> None:
    with pytest.raises(UserError, match=r"new\.csv: --errors names the file of -o too"):
        check_apart(["t.csv"], {"-o": "./new.csv", "--errors": "new.csv"})
    check_apart(["t.csv", "-", "none"], {"-o": "/dev/null", "--errors": "/dev/null", "x": None})


def test_a_read_only_file_stays(folder: Path) -> None:
    (folder / "kept.csv").write_text("kept", "utf-8")
    (folder / "kept.csv").chmod(0o444)
    done = impact88("solve", "t.csv", "-o", "kept.csv")
    assert (done.returncode, done.stdout) == (2, "")
    assert "kept.csv: is read-only" in done.stderr
    assert (folder / "kept.csv").read_text("utf-8") == "kept"


# --- disks and signals ---------------------------------------------------------------------------


def test_the_bytes_are_on_the_disk_before_the_name(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    steps: list[str] = []
    sync, rename = os.fsync, os.replace
    monkeypatch.setattr(os, "fsync", lambda handle: steps.append("sync") or sync(handle))
    monkeypatch.setattr(os, "replace", lambda *both: steps.append("rename") or rename(*both))
    with replacing("new.txt") as file:
        file.write("x" * 300_000)
    assert steps == ["sync", "rename"]
    assert (folder / "new.txt").stat().st_size == 300_000


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no full device here")
@pytest.mark.parametrize(
    "line",
    ["solve t.csv --to jsonl", "run --sample 1", "run --help", "--help"],
)
def test_full_standard_output_is_named(folder: Path, line: str) -> None:
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            [COMMAND, *line.split()], stdout=full, stderr=subprocess.PIPE, text=True, check=False
        )
    assert done.returncode == 2
    command = "" if line == "--help" else f" {line.split()[0]}"
    assert done.stderr == f"impact88{command}: standard output: {os.strerror(28)}\n"


@pytest.mark.parametrize(
    "line",
    [
        "solve big.csv -o old.csv",
        "solve big.csv -o old.jsonl",
        "solve big.csv -o old.npz",
        "run --sample 1 --slot 1 --printer old.txt",
        "figure scene --sample 1 -o old.svg",
    ],
)
def test_a_disk_that_fills_up_keeps_the_old_file(folder: Path, line: str) -> None:
    """A file may grow to 64 bytes here: the file system says so in the words of a full disk."""
    (folder / "big.csv").write_text(ROWS + (ROWS.splitlines()[1] + "\n") * 40, "utf-8")
    old = line.split()[-1]
    (folder / old).write_text("old", "utf-8")
    code = (
        "import resource, signal, sys; signal.signal(signal.SIGXFSZ, signal.SIG_IGN);"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (64, 64));"
        "from impact88.interface.commands.cli import main; sys.exit(main(sys.argv[1:]))"
    )
    done = subprocess.run(
        [sys.executable, "-B", "-c", code, *line.split()],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 2, done.stderr
    said = f"impact88 {line.split()[0]}: {old}: cannot be written: {os.strerror(27)}\n"
    assert done.stderr == said
    assert (folder / old).read_text("utf-8") == "old"
    assert names(folder) == {"t.csv", "big.csv", old}


def test_save_on_a_full_disk_is_an_error_in_the_session(folder: Path) -> None:
    done = impact88("basic", input="SAVE /dev/full\nPRINT 7*6\n")
    assert done.returncode == 0
    assert "42" in done.stdout
    assert done.stderr == f"impact88 basic: /dev/full: cannot be written: {os.strerror(28)}\n"


@pytest.mark.skipif(not os.path.exists("/proc/self/mem"), reason="no such file here")
def test_an_error_in_reading_names_the_file() -> None:
    with pytest.raises(UserError, match="/proc/self/mem: cannot be read"):
        read_bytes("/proc/self/mem")
    done = impact88("solve", "/proc/self/mem", "--from", "csv")
    assert done.returncode == 2
    assert done.stderr.startswith("impact88 solve: /proc/self/mem: cannot be read: ")


@pytest.mark.parametrize(
    "number", long_but([signal.SIGTERM, signal.SIGHUP, signal.SIGINT], kept=(2,))
)
def test_a_signal_leaves_the_old_file_and_nothing_beside_it(folder: Path, number: int) -> None:
    (folder / "old.csv").write_text("old", "utf-8")
    with subprocess.Popen(
        [sys.executable, "-c", _WORKS_ON_CONTROL_C, "solve", "-", "-o", "old.csv"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        assert process.stdin is not None
        assert process.stderr is not None
        # more than the first block, whose units the headings of the results depend on
        process.stdin.write(ROWS + ROWS.partition("\n")[2] * 60_000)
        process.stdin.flush()
        _until(lambda: any(name.endswith(".part") for name in names(folder)))
        process.send_signal(number)
        if number == signal.SIGINT:
            process.send_signal(number)
        assert process.wait(120) == 128 + number
        assert process.stderr.read() == ""
    assert names(folder) == {"t.csv", "old.csv"}
    assert (folder / "old.csv").read_text("utf-8") == "old"


def test_a_signal_in_the_moment_the_temporary_file_is_made_leaves_none(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    opened = os.open
    made = []

    def interrupted(path: str, flags: int, mode: int = 0o777) -> int:
        os.close(opened(path, flags, mode))
        made.append(Path(path).name)
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "open", interrupted)
    with pytest.raises(KeyboardInterrupt), replacing("new.csv"):
        pytest.fail("nothing was opened")
    assert len(made) == 1
    assert names(folder) == {"t.csv"}


@pytest.mark.parametrize("letter", ["x", "µ", "衝", "🚗"])
def test_the_longest_name_a_file_can_have_is_written(folder: Path, letter: str) -> None:
    name = letter * (255 // len(letter.encode()))
    with replacing(name) as file:
        file.write("new")
    assert Path(name).read_text("utf-8") == "new"
    assert names(folder) == {"t.csv", name}


_WORKS_ON_CONTROL_C = (
    "import signal, sys; signal.signal(signal.SIGINT, signal.default_int_handler);"
    "[signal.signal(getattr(signal, n), signal.SIG_DFL) for n in ('SIGTERM', 'SIGHUP')];"
    "from impact88.interface.commands.cli import main; sys.exit(main(sys.argv[1:]))"
)
"""A shell's background job ignores control-C, and one behind nohup SIGHUP: so would the commands
started here, which inherit that."""


def _until(true: Callable[[], bool]) -> None:
    deadline = time.monotonic() + 100.0
    while time.monotonic() < deadline:
        if true():
            return
        time.sleep(0.05)
    pytest.fail("it did not begin")


def test_control_c_in_a_program_keeps_what_was_printed_before(folder: Path) -> None:
    (folder / "p.bas").write_text('10 PR# 1:PRINT "NEW":PR# 0:PRINT "ON"\n20 GOTO 20\n', "utf-8")
    (folder / "paper.txt").write_text("old", "utf-8")
    line = "basic p.bas --no-dos --printer paper.txt"
    with subprocess.Popen(
        [sys.executable, "-u", "-c", _WORKS_ON_CONTROL_C, *line.split()],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        text=True,
    ) as process:
        assert process.stdout is not None
        while "ON" not in (line := process.stdout.readline()):
            assert line
        process.send_signal(signal.SIGINT)
        assert process.wait(120) == 130
    assert (folder / "paper.txt").read_text("utf-8") == "old"
    assert names(folder) == {"t.csv", "p.bas", "paper.txt"}


def test_with_an_unreadable_printout_no_report_is_written(folder: Path) -> None:
    (folder / "letter.txt").write_text("Dear sir,\nno printout is enclosed.\n", "utf-8")
    done = impact88("verify", "letter.txt", "--report", "r.html")
    assert done.returncode == 2
    assert names(folder) == {"t.csv", "letter.txt"}


@pytest.mark.parametrize(
    ("start", "name"),
    [
        (b"GIF89a", "a GIF picture"),
        (b"BM\x36\0\0\0", "a BMP picture"),
        (b"P6\n640 480\n255\n", "a PPM picture"),
        (b"RIFF\0\0\0\0WEBPVP8 ", "a WebP picture"),
        (b"\0\0\0\x18ftypheic", "a HEIC picture"),
    ],
)
@pytest.mark.parametrize("command", ["verify", "solve", "run"])
def test_a_file_is_known_by_its_content(tmp_path, capsys, start, name, command):
    """Whatever it is called, and however long it is."""
    path = tmp_path / ("t.csv" if command == "solve" else "t.txt")
    path.write_bytes(start + bytes(90_000 if command == "run" else 3_000_000))
    assert main([command, str(path)]) == 2
    err = capsys.readouterr().err
    assert f"is {name}; expected" in err
    assert "PNG, JPEG, TIFF or PDF" in err


def test_a_text_that_begins_with_two_letters_of_a_picture_is_a_text(tmp_path, capsys):
    path = tmp_path / "t.csv"
    path.write_text("BM,MU\n1,2\n")
    assert main(["solve", str(path)]) == 2
    assert "no column E" in capsys.readouterr().err


def test_json_holds_nothing_that_turns_a_terminal_round(tmp_path, capsys):
    path = tmp_path / "t.txt"
    path.write_text(
        packaged_text("impact88.legacy", "run1-as-printed.txt") + "note \u202e behind\n"
    )
    main(["verify", "--json", str(path)])
    out = capsys.readouterr().out
    assert out.replace("\n", "").isprintable()
    assert "note \u202e behind" in json.loads(out)["left_over"][0]["read"]
