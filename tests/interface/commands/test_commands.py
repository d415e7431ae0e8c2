"""The installed command: what it says, how it leaves, and that it never shows a traceback."""

from __future__ import annotations

import os
import pty
import select
import signal
import subprocess
import sys
from collections.abc import Iterator
from functools import cache
from importlib import import_module
from pathlib import Path

import pytest
from captures import ROOT
from guide import guide
from installed import COMMAND, process
from installed import impact88 as command

import impact88
from impact88.collision.casescene import Scene, sample
from impact88.interface.commands import CHAPTER, CHAPTER_MEANING, GROUPS, module_of
from impact88.interface.commands.cli import COMMANDS, main

needs_full_device = pytest.mark.skipif(
    not os.path.exists("/dev/full"), reason="this system has no /dev/full"
)


def assert_one_line(stderr: str) -> None:
    assert "Traceback" not in stderr
    assert stderr.count("\n") == 1, stderr
    assert stderr.startswith("impact88")


def test_version() -> None:
    done = process("--version")
    assert (done.returncode, done.stdout, done.stderr) == (
        0,
        f"impact88 {impact88.__version__}\n",
        "",
    )


COMMANDS_FOLDER = Path(impact88.__file__).parent / "interface/commands"
MODULES = {path.stem for path in COMMANDS_FOLDER.glob("*_command.py")}


def test_every_module_of_a_command_is_registered() -> None:
    registered = {module_of(name).rpartition(".")[2] for name in COMMANDS}
    for stem in sorted(MODULES - registered):
        pytest.fail(
            f"interface/commands/{stem}.py is no command yet; next step: its row in ROWS of "
            "interface/commands/__init__.py (name, group, summary)"
        )


@pytest.mark.parametrize("name", COMMANDS)
def test_every_registered_command_is_complete(name: str) -> None:
    stem = module_of(name).rpartition(".")[2]
    assert stem in MODULES, (
        f"{name} has a row in ROWS of interface/commands/__init__.py and no module; next step: "
        f"interface/commands/{stem}.py with ARGUMENTS and main"
    )
    module = import_module(module_of(name))
    for part in ("ARGUMENTS", "main"):
        assert hasattr(module, part), f"next step: {part} in interface/commands/{stem}.py"
    assert module.__doc__, (
        f"next step: the end of the help, as docstring of interface/commands/{stem}.py"
    )
    # README's table of commands is one step, an example another
    readme = (ROOT / "README.md").read_text("utf-8").splitlines()
    prose = "\n".join(line for line in readme if not line.startswith("|"))
    words = f"impact88 {'chapter ' if name in CHAPTER else ''}{name}"
    assert words in prose + guide(), (
        f"no page for users says {words}; next step: an example in a chapter of "
        "port/docs/guide/, which tests/doors/test_readme.py runs"
    )


def test_help_lists_every_command_and_the_exit_statuses() -> None:
    done = command("--help")
    assert done.returncode == 0
    assert done.stderr == ""
    assert {word for group in GROUPS.values() for word in group} == {*COMMANDS, "chapter"} - {
        *CHAPTER
    }
    for name in {*COMMANDS, "chapter"} - {*CHAPTER}:
        line = COMMANDS.get(name, CHAPTER_MEANING)
        assert any(row.split() == [name, *line.split()] for row in done.stdout.splitlines()), name
    assert "exit status: 0 done, 1 adverse result, 2 unusable input" in done.stdout


@pytest.mark.parametrize("columns", ["66", "80", "200"])
def test_help_fits_the_terminal(
    columns: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", columns)
    for words in ([], ["chapter"], *([name] for name in COMMANDS)):
        assert main([*words, "--help"]) == 0
        widest = max(capsys.readouterr().out.splitlines(), key=len)
        assert len(widest) <= int(columns), widest
    assert len(widest) > 40


def test_the_chapter_s_problems_stand_under_one_word() -> None:
    for name in CHAPTER:
        assert command("help", "chapter", name).stdout == command(name, "--help").stdout
    refused = command("chapter", "barier")
    assert refused.returncode == 2
    assert "did you mean barrier?" in refused.stderr


@pytest.mark.parametrize(
    ("words", "hint"),
    [
        (["solve", "x.csv", "--ouputs=LOSS"], "--outputs"),
        (["figure", "scen", "-o", "x.svg"], "scene"),
        (["witness", "--rom", "x", "--captues", "3"], "--captures"),
        (["oracle", "--class", "edgy"], "edge"),
    ],
)
def test_a_misspelled_option_or_choice_is_pointed_at(words: list[str], hint: str) -> None:
    assert f"; did you mean {hint}?" in command(*words).stderr


@pytest.mark.parametrize("shell", ["bash", "zsh", "tcsh"])
def test_completion_knows_every_command(shell: str) -> None:
    pytest.importorskip("shtab", reason="extra: completion")
    done = command("completion", shell)
    assert done.returncode == 0, done.stderr
    known = (*COMMANDS, "--outputs") if shell != "tcsh" else ("verify", "outputs")
    assert all(name in done.stdout for name in (*known, "chapter"))


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_has_help_and_refuses_an_unknown_option(name: str) -> None:
    asked = command(name, "--help")
    assert asked.returncode == 0, asked.stderr
    where = "chapter " if name in CHAPTER else ""
    assert asked.stdout.startswith(f"usage: impact88 {where}{name}")
    refused = command(name, "--no-such-option")
    assert refused.returncode == 2
    assert refused.stdout == ""
    assert_one_line(refused.stderr)
    assert refused.stderr.startswith(f"impact88 {name}: ")


@pytest.mark.parametrize("arguments", [(), ("",), ("frobnicate",), ("--sample", "1"), ("RUN",)])
def test_what_is_no_command_is_refused_in_one_line(arguments: tuple[str, ...]) -> None:
    done = command(*arguments)
    assert done.returncode == 2
    assert done.stdout == ""
    assert_one_line(done.stderr)


@pytest.mark.parametrize("arguments", [("run", "--sample", "2"), ("x",)])
def test_module_is_the_command(arguments: tuple[str, ...]) -> None:
    installed = process(*arguments)
    assert vars(installed) | {"args": ()} == vars(command(*arguments)) | {"args": ()}
    module = subprocess.run(
        [sys.executable, "-m", "impact88", *arguments],
        capture_output=True,
        encoding="utf-8",
        input="",
        timeout=120,
        check=False,
    )
    assert module.returncode == installed.returncode
    assert module.stdout == installed.stdout
    assert module.stderr == installed.stderr


# what the shell may do to the streams


@pytest.mark.parametrize("arguments", [("--help",), ("run", "--sample", "1")])
def test_broken_pipe_is_quiet(arguments: tuple[str, ...]) -> None:
    reading, writing = os.pipe()
    os.close(reading)
    try:
        done = subprocess.run(
            [COMMAND, *arguments],
            stdin=subprocess.DEVNULL,
            stdout=writing,
            stderr=subprocess.PIPE,
            timeout=120,
            check=False,
        )
    finally:
        os.close(writing)
    assert done.returncode == 128 + signal.SIGPIPE
    assert done.stderr == b""


@needs_full_device
@pytest.mark.parametrize("arguments", ["--version", "run --sample 1"])
def test_full_disk_is_one_line(arguments: str) -> None:
    done = shell(f'"$COMMAND" {arguments} >/dev/full')
    assert done.returncode == 2
    assert_one_line(done.stderr)
    assert os.strerror(28) in done.stderr


def test_closed_output_is_one_line() -> None:
    done = shell('"$COMMAND" run --sample 1 >&-')
    assert done.returncode == 2
    assert_one_line(done.stderr)


def test_closed_error_stream_does_not_reach_the_result() -> None:
    done = shell('"$COMMAND" frobnicate 2>&-')
    assert (done.returncode, done.stdout) == (2, "")


def test_closed_input_is_input_that_ended() -> None:
    done = shell('"$COMMAND" run <&-')
    assert done.returncode == 2
    assert_one_line(done.stderr)


def shell(line: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        ["sh", "-c", line],
        env={**os.environ, "COMMAND": COMMAND},
        stdin=subprocess.DEVNULL,
        capture_output=True,
        encoding="utf-8",
        timeout=120,
        check=False,
    )


# run


@pytest.mark.parametrize("sample", ["1", "2", "3"])
def test_run_prints_a_sample(sample: str) -> None:
    done = command("run", "--sample", sample)
    assert (done.returncode, done.stderr) == (0, "")
    assert "KE LOSS= " in done.stdout


def test_run_ends_with_one_after_an_applesoft_error() -> None:
    done = command("run", "--sample", "1", "--set", "IA=0")
    assert done.returncode == 1
    assert "?DIVISION BY ZERO ERROR IN 480" in done.stdout
    assert "Traceback" not in done.stderr


def test_zero_determinant_is_an_end_like_any_other() -> None:
    done = command("run", "--sample", "1", "--set", "MA=0")
    assert done.returncode == 0
    assert done.stdout.endswith("ZERO DETERMINANT\n")


@pytest.mark.parametrize(
    "arguments",
    [
        ("no-such-file.toml",),
        (".",),
        ("--sample", "4"),
        ("--sample", "1", "--set", "XX=1"),
        ("--sample", "1", "--set", "MU"),
        ("--sample", "1", "--set", "MU=much"),
        ("--sample", "1", "--arithmetic", "decimal"),
        ("--sample", "1", "--slot", "9"),
    ],
)
def test_run_refuses_what_it_cannot_use_in_one_line(
    arguments: tuple[str, ...], tmp_path: Path
) -> None:
    done = command("run", *arguments, cwd=tmp_path)
    assert done.returncode == 2
    assert done.stdout == ""
    assert_one_line(done.stderr)


def test_scene_file_with_bytes_that_are_no_text_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "scene.toml"
    file.write_bytes(b'MU = "\xff\xfe"\n')
    done = command("run", str(file))
    assert (done.returncode, done.stdout) == (2, "")
    assert_one_line(done.stderr)
    assert "scene.toml" in done.stderr


def test_scene_template_names_the_samples_values_and_runs(tmp_path: Path) -> None:
    file = tmp_path / "scene.toml"
    file.write_text(command("scene", "--sample", "2").stdout, encoding="utf-8")
    assert command("run", str(file)).stdout == command("run", "--sample", "2").stdout


def test_run_reads_the_velocities_from_standard_input() -> None:
    done = command("run", input="-29.04,0,0\n14.52,25.15,0\n")
    assert (done.returncode, done.stderr) == (0, "")
    sample = command("run", "--sample", "1").stdout
    assert done.stdout[done.stdout.index("MA= ") :] == sample[sample.index("MA= ") :]


def test_input_that_ends_at_a_prompt_is_one_line() -> None:
    done = command("run", input="-29.04,0,0\n")
    assert done.returncode == 2
    assert "COMPONENTS OF MB" in done.stdout
    assert_one_line(done.stderr)


def test_replies_without_end_are_refused() -> None:
    done = command("run", "--json", input="yes\n" * 20_000)
    assert (done.returncode, done.stdout) == (2, "")
    assert_one_line(done.stderr)
    assert "10,000 replies" in done.stderr


class Terminal:
    """The command on a terminal of its own."""

    def __init__(self, *arguments: str) -> None:
        self.process, self.screen = pty.fork()
        if self.process == 0:
            try:
                os.execv(COMMAND, [COMMAND, *arguments])
            finally:
                os._exit(127)
        self.shown = ""

    def read(self) -> bool:
        """More of what is on the screen; false when the command has left."""
        ready, _, _ = select.select([self.screen], [], [], 60)
        if not ready:
            os.kill(self.process, signal.SIGKILL)
            pytest.fail(f"nothing came any more after {self.shown!r}")
        try:
            data = os.read(self.screen, 4096)
        except OSError:  # how a terminal says that nobody is left at the other end
            data = b""
        self.shown += data.decode()
        return bool(data)

    def read_until(self, text: str) -> None:
        start = len(self.shown)
        while text not in self.shown[start:]:
            assert self.read(), self.shown

    def type(self, keys: str) -> None:
        os.write(self.screen, keys.encode())

    def interrupt(self) -> None:
        """Type control-C, and again where nothing follows within seconds, as people do: Python does
        not notice a signal that comes just before it begins to wait for the terminal."""
        for _ in range(10):
            self.type("\x03")
            start = len(self.shown)
            while select.select([self.screen], [], [], 5)[0]:
                if not self.read():
                    return
                if "\n" in self.shown[start:]:  # more than the echo
                    return

    def leave(self) -> int:
        while self.read():
            pass
        os.close(self.screen)
        _, status = os.waitpid(self.process, 0)
        return os.waitstatus_to_exitcode(status)


def test_run_on_a_terminal_prompts_and_does_not_repeat_the_echo() -> None:
    terminal = Terminal("run")
    terminal.read_until("?")
    terminal.type("-29.04,0,0\n")
    terminal.read_until("?")
    terminal.type("14.52,25.15,0\n")
    assert terminal.leave() == 0
    shown = terminal.shown.replace("\r\n", "\n")
    assert shown.count("-29.04,0,0\n") == 1
    assert "XB= 14.51 YB= 25.14\n" in shown


@pytest.fixture
def control_c_works() -> Iterator[None]:
    """A shell's background job ignores control-C, and so would the commands started here."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("control_c_works")
def test_control_c_at_a_prompt_leaves_without_a_traceback() -> None:
    terminal = Terminal("run")
    terminal.read_until("?")
    terminal.interrupt()
    assert terminal.leave() == 128 + signal.SIGINT
    assert "Traceback" not in terminal.shown


@pytest.mark.usefixtures("control_c_works")
def test_interrupt_signal_at_a_prompt_leaves_without_a_traceback() -> None:
    with subprocess.Popen(
        [COMMAND, "run"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        bufsize=0,
    ) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        shown = b""
        while b"?" not in shown:  # the prompt comes before the reply is waited for
            data = process.stdout.read(4096)
            assert data
            shown += data
        process.send_signal(signal.SIGINT)
        assert process.wait(timeout=60) == 128 + signal.SIGINT
        assert b"Traceback" not in process.stderr.read()


def test_first_commands_import_neither_numpy_nor_matplotlib() -> None:
    code = (
        "import sys\n"
        "from impact88.interface.commands.cli import main\n"
        "commands = ['run --sample 1', 'scene', '--help']\n"
        "status = max(main(command.split()) for command in commands)\n"
        "heavy = {'numpy', 'matplotlib', 'mpmath', 'scipy'} & set(sys.modules)\n"
        "sys.exit(f'{status} {heavy}' if status or heavy else 0)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, encoding="utf-8", check=False
    )
    assert done.returncode == 0, done.stderr


def test_running_the_1988_program_loads_little() -> None:
    """Start-up is most of the time of a short run: numpy and typing alone would double it."""
    loads = "import sys; known = set(sys.modules); "
    loads += "import impact88.interface.commands.cli, impact88.interface.commands.run_command; "
    loads += "print(*sorted(set(sys.modules) - known))"
    done = subprocess.run([sys.executable, "-c", loads], capture_output=True, text=True, check=True)
    assert not {"numpy", "matplotlib", "typing", "dataclasses"} & set(done.stdout.split())


NEVER = ("pathlib", "urllib.parse", "concurrent.futures", "threading", "importlib.resources")
"""Modules of the standard library that no command of `NOT_IMPORTED` needs."""
NOT_IMPORTED = {
    "run --sample 1": ("numpy", *NEVER),
    "run plain.toml": ("numpy", "fractions", "impact88.collision.units", *NEVER),
    "verify page.txt": ("fractions", "glob", "impact88.collision.units", *NEVER),
    "figure scene --sample 1 -o scene.svg": (
        "matplotlib",
        "impact88.casework.figures.charts",
        "impact88.tables",
        *NEVER,
    ),
    "solve one.csv": ("pyarrow", "pandas", *NEVER),
    "help verify": ("numpy", *NEVER),
}
"""Command -> modules that it does without: each takes part of a short command's time."""


@pytest.mark.parametrize("words", NOT_IMPORTED)
def test_a_command_imports_nothing_that_it_does_without(tmp_path: Path, words: str) -> None:
    scene = sample(1)
    (tmp_path / "page.txt").write_text(impact88.run(scene).page)
    (tmp_path / "plain.toml").write_text("".join(f'{n} = "{text}"\n' for n, text in scene.items()))
    (tmp_path / "one.csv").write_text(f"{','.join(scene)}\n{','.join(scene.values())}\n")
    code = (
        "import sys\n"
        "from impact88.interface.commands.cli import main\n"
        "known = set(sys.modules)\n"
        "status = main(sys.argv[1:])\n"
        "print(status, *sorted(set(sys.modules) - known), file=sys.stderr)\n"
    )
    command_line = [sys.executable, "-c", code, *words.split()]
    done = subprocess.run(command_line, cwd=tmp_path, capture_output=True, text=True, check=True)
    status, *imported = done.stderr.splitlines()[-1].split()
    assert status == "0"
    of_numpy = _imported_by_numpy() - {"numpy"} if "numpy" in imported else set()
    assert not set(NOT_IMPORTED[words]) & set(imported) - of_numpy


@cache
def _imported_by_numpy() -> set[str]:
    code = "import numpy, sys; print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return set(done.stdout.split())


def test_garbage_of_a_process_of_its_own_is_collected_seldom() -> None:
    """And that of a caller within Python as the caller has it."""
    code = (
        "import gc, sys\n"
        "from impact88.interface.commands.cli import main\n"
        "usual, frozen = gc.get_threshold(), gc.get_freeze_count()\n"
        "main(['--version'])\n"
        "assert gc.get_threshold() == usual and gc.get_freeze_count() == frozen\n"
        "sys.argv = ['impact88', '--version']\n"
        "main()\n"
        "assert gc.get_threshold()[0] > usual[0] and gc.get_freeze_count() > frozen\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_help_of_a_command_and_the_version_in_short() -> None:
    assert command("help", "run").stdout == command("run", "--help").stdout
    assert command("-V").stdout == command("--version").stdout


def test_a_command_near_the_one_typed_is_pointed_at() -> None:
    done = command("slove")
    assert done.returncode == 2
    assert "'slove' is not a command; did you mean solve?" in done.stderr


def test_the_result_is_utf_8_whatever_the_locale(tmp_path: Path) -> None:
    done = subprocess.run(
        [COMMAND, "scene", "--sample", "1"],
        capture_output=True,
        env={**os.environ, "PYTHONIOENCODING": "cp1252", "LC_ALL": "C"},
        check=True,
    )
    path = tmp_path / "crash.toml"
    path.write_bytes(done.stdout)
    assert Scene.from_toml(str(path)) == sample(1)


def test_a_missing_library_is_no_bug(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.delitem(sys.modules, "impact88.interface.commands.solving", raising=False)
    monkeypatch.setitem(sys.modules, "numpy", None)
    assert main(["solve", "cases.csv"]) == 2
    assert "numpy is not installed; expected: pip install numpy" in capsys.readouterr().err


@pytest.mark.parametrize("command", ["solve", "run", "delta-v"])
def test_help_does_not_wait_for_numpy(command: str) -> None:
    code = "import sys; from impact88.interface.commands.cli import main\n"
    code += f"main(['help', {command!r}]); "
    code += "sys.exit('numpy' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True).returncode == 0
