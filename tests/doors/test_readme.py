"""The examples of README and of the guide are run, and print what is shown.

In a ``console`` block a line that begins with ``$`` is a command and what follows is its output, in
order of appearance on the terminal; a line ``...`` stands for any lines. All blocks share one
folder, where a ``csv`` or ``toml`` block stands under the name given before it. The ``pycon``
blocks are one Python session. Control characters are not compared: they cannot be seen in
README, and other tests compare them.
"""

from __future__ import annotations

import doctest
import json
import os
import re
import shlex
import socket
import subprocess
from pathlib import Path

import pytest
from captures import ROOT
from extras import run_with
from guide import guide
from installed import COMMAND, impact88
from longer import long_but

from impact88.collision.casescene import sample
from impact88.interface.commands.cli import COMMANDS
from impact88.names import SCENE

README = (ROOT / "README.md").read_text(encoding="utf-8")
GUIDE = guide()
BOTH = f"{README}\n{GUIDE}"
TEST_COMMAND = "python3 -m venv .venv && .venv/bin/pip install -e '.[test]' && .venv/bin/pytest"
FIRST_COMMAND = (
    "python3 -m venv .venv && .venv/bin/pip install . && .venv/bin/impact88 run --sample 1"
)


def blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```$", BOTH, re.M | re.S)


def crash_file() -> str:
    """README's collision with dimensions."""
    found = re.search(r"`crash.toml`:\n\n```toml\n(.*?)^```$", README, re.M | re.S)
    assert found is not None
    return found[1]


def examples() -> list[tuple[str, str]]:
    """Each command of the console blocks with the output shown for it."""
    found = []
    for block in blocks("console"):
        assert block.startswith("$ ")
        for example in re.split(r"^\$ ", block, flags=re.M)[1:]:
            command, _, output = example.partition("\n")
            found.append((command, output))
    return found


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where the examples run, one after the other; legacy/ is found there as in the checkout."""
    folder = tmp_path_factory.mktemp("readme")
    (folder / "legacy").symlink_to(ROOT / "legacy")
    for name, table in re.findall(
        r"[Ww]ith\s`(\S+)`:\n\n```(?:csv|toml)\n(.*?)^```$", BOTH, re.M | re.S
    ):
        (folder / name).write_text(table, encoding="utf-8")
    return folder


def visible(text: str) -> list[str]:
    return [line.rstrip() for line in re.sub(r"[\0\a\f]", "", text).rstrip("\n").split("\n")]


def matches(shown: list[str], printed: list[str]) -> bool:
    pattern = "".join(r"(?:.*\n)*" if line == "..." else re.escape(line) + r"\n" for line in shown)
    return re.fullmatch(pattern, "".join(f"{line}\n" for line in printed)) is not None


@pytest.mark.parametrize(("command", "shown"), examples())
def test_example_prints_what_readme_shows(command: str, shown: str, folder: Path) -> None:
    words = shlex.split(command, comments=True)
    if words[0] == "impact88" and not {"|", "<", ">", "&&", ";"} & set(words):
        done = impact88(*words[1:], cwd=folder)
        both = done.stderr + done.stdout
    else:
        both = in_a_shell(command, folder)
    if not matches(visible(shown), visible(both)):
        assert visible(both) == visible(shown)


def in_a_shell(command: str, folder: Path) -> str:
    done = subprocess.run(
        ["bash", "-c", command],
        cwd=folder,
        env={**os.environ, "PATH": f"{Path(COMMAND).parent}:{os.environ['PATH']}"},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        encoding="utf-8",
        timeout=120,
        check=False,
    )
    return done.stdout


def test_python_session(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(folder)
    session = "\n".join(blocks("pycon"))
    test = doctest.DocTestParser().get_doctest(session, {}, "README.md", "README.md", 0)
    assert test.examples
    assert doctest.DocTestRunner().run(test).failed == 0, capsys.readouterr().out


def test_first_screen_holds_the_first_command_and_its_page() -> None:
    """The install commands are not run here: .ci/run runs the second in a fresh environment."""
    screen = "\n".join(README.split("\n")[:28])
    assert [block.strip() for block in blocks("sh")][:2] == [FIRST_COMMAND, TEST_COMMAND]
    assert FIRST_COMMAND in screen
    assert "VAX= -13.263 VAY= 3.449" in screen


def test_every_command_is_mentioned() -> None:
    missing = [name for name in COMMANDS if f"{name}`" not in README]
    assert not missing, f"next step: {missing[0]} in README.md's table of commands"


def anchors(text: str) -> set[str]:
    """Where a heading can be linked to, as the usual renderers name it."""
    headings = re.findall(r"^#+ (.*)$", text, re.M)
    return {re.sub(r"[^a-z0-9 -]", "", h.lower()).replace(" ", "-") for h in headings}


def test_links_lead_somewhere() -> None:
    links = [link for link in re.findall(r"\]\(([^)]+)\)", README) if "://" not in link]
    assert links
    assert {link.removeprefix("#") for link in links if link.startswith("#")} <= anchors(README)
    files = [link.partition("#")[0] for link in links if not link.startswith("#")]
    assert [link for link in files if not (ROOT / link).is_file()] == []


def test_readme_links_what_the_faithful_path_is_checked_by() -> None:
    for path in ("port/impact88/program/listing.py", "legacy/impact.bas", "legacy/ERRATA.md"):
        assert f"]({path})" in README
    assert "](golden/" in README


TOURS: dict[str, tuple[str, ...]] = {
    "verify --brief printout.txt": (),
    "verify --report page.html printout.txt": ("report",),
    "bounds crash.toml --outputs DVA,DVB": (),
    "report crash.toml -o case.html": ("report",),
    "figure scene crash.toml -o crash.svg": (),
    "oracle --vectors 3 -o vectors.jsonl": (),
    "compare theirs.jsonl --strict": (),
    "desk --no-browser --port {taken}": ("desk",),
}
"""README's tours, and the extras that README names for them."""


@pytest.mark.parametrize(("line", "extras"), long_but(TOURS.items(), kept=(0, 3, 7)))
def test_a_tour_needs_the_extras_it_names_and_no_other(
    line: str, extras: tuple[str, ...], tmp_path: Path
) -> None:
    folder = tmp_path
    (folder / "crash.toml").write_text(crash_file(), "utf-8")
    (folder / "theirs.jsonl").write_text(json.dumps({**sample(1), "VAX": -13.263}), "utf-8")
    impact88("run", "--sample", "1", "-o", "printout.txt", cwd=folder)
    with socket.create_server(("127.0.0.1", 0)) as taken:
        words = line.format(taken=taken.getsockname()[1]).split()
        for extra in extras:
            assert f"`{extra}`" in README or f"extra {extra}" in README
            without = run_with((), *words, cwd=folder)
            assert without.returncode == 2
            assert f"pip install 'impact88[{extra}]'" in without.stderr
        done = run_with(extras, *words, cwd=folder)
    if words[0] == "desk":  # it would serve for ever: that all is there shows in what it lacks
        assert "is not available" in done.stderr
    else:
        assert done.returncode in (0, 1), done.stderr


PAGES = ["README.md", "port/README.md", "port/CHANGELOG.md", "tests/README.md"]


@pytest.mark.parametrize("page", [*PAGES, "the guide"])
def test_files_and_rooms_named_are_there(page: str) -> None:
    text = GUIDE if page == "the guide" else (ROOT / page).read_text(encoding="utf-8")
    named = re.findall(r"`([A-Za-z0-9_./-]+(?:\.py|\.md|/))`", text)
    assert named
    places = [ROOT, ROOT / "port", ROOT / "port" / "impact88", ROOT / "tests", ROOT / "golden"]
    assert [name for name in named if not any((place / name).exists() for place in places)] == []


def test_the_table_of_names_is_names_py_s() -> None:
    rows = [
        f"| `{q.name}` | {q.symbol} | {q.meaning} | {q.unit} | {q.line} |" for q in SCENE.values()
    ]
    assert "\n".join(rows) in GUIDE


def test_every_addition_names_a_test_that_names_the_next_step() -> None:
    page = (ROOT / "port" / "README.md").read_text(encoding="utf-8")
    adding = page.partition("## Adding things")[2].partition("\n## ")[0]
    headings = re.findall(r"^\*\*.+?\*\* \((.+)\)$", adding, re.MULTILINE)
    assert len(headings) == adding.count("\n**")
    for heading in headings:
        named = re.findall(r"`(tests/\S+\.py)`", heading)
        assert named
        for test in named:
            assert "next step" in (ROOT / test).read_text(encoding="utf-8"), test
