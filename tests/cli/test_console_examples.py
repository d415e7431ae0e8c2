"""The examples of README and of the guide print what is shown.

In a ``console`` block a line that begins with ``$`` is a command, and what follows is what the
terminal shows, standard error first; a line ``...`` stands for any lines. All blocks of a page
share one folder, in which a ``toml`` or ``csv`` block is the file named in the line before it. The
``pycon`` blocks of a page are one Python session."""

from __future__ import annotations

import doctest
import re
import shlex
from pathlib import Path

import pytest
from commands import command, shell

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "port" / "docs" / "guide").glob("*.md"))]
FILE = re.compile(r"`([\w.-]+)`:\n\n```(?:toml|csv)\n(.*?)^```$", re.M | re.S)
LONG_PAGES = ("programs.md",)  # tests/comparison compares shorter tables
SHELL_WORDS = {"|", "<", ">", "&&", ";"}


def blocks(page: Path, language: str) -> list[str]:
    """Return the blocks of a page in one language."""
    return re.findall(rf"^```{language}\n(.*?)^```$", page.read_text("utf-8"), re.M | re.S)


def visible_lines(text: str) -> list[str]:
    """Return the lines that a reader sees."""
    return [line.rstrip() for line in re.sub(r"[\0\a\f]", "", text).rstrip("\n").split("\n")]


def is_shown(pattern_lines: list[str], lines: list[str]) -> bool:
    """Return True if lines are those of a page, in which ``...`` stands for any."""
    pattern = "".join(
        r"(?:.*\n)*" if line == "..." else re.escape(line) + r"\n" for line in pattern_lines
    )
    return re.fullmatch(pattern, "".join(f"{line}\n" for line in lines)) is not None


def page_name(page: Path) -> str:
    return page.name


CONSOLE_PAGES = [
    pytest.param(page, marks=[pytest.mark.long] * (page.name in LONG_PAGES), id=page.name)
    for page in PAGES
    if blocks(page, "console")
]


@pytest.mark.parametrize("page", CONSOLE_PAGES)
def test_console_examples_print_what_is_shown(page: Path, tmp_path: Path) -> None:
    for folder in ("legacy", "golden"):
        (tmp_path / folder).symlink_to(ROOT / folder)
    for name, text in FILE.findall(page.read_text("utf-8")):
        (tmp_path / name).write_text(text, "utf-8")
    for block in blocks(page, "console"):
        assert block.startswith("$ ")
        for example in re.split(r"^\$ ", block, flags=re.M)[1:]:
            line, _, text = example.partition("\n")
            words = shlex.split(line, comments=True)
            if words[0] == "impact88" and not SHELL_WORDS & set(words):
                outcome = command(*words[1:], folder=tmp_path)
            else:
                outcome = shell(line, tmp_path)
            lines = visible_lines(outcome.err + outcome.out)
            if not is_shown(visible_lines(text), lines):
                assert lines == visible_lines(text), line


@pytest.mark.parametrize("page", [p for p in PAGES if blocks(p, "pycon")], ids=page_name)
def test_python_examples_print_what_is_shown(
    page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    session = "\n".join(blocks(page, "pycon"))
    examples = doctest.DocTestParser().get_doctest(session, {}, page.name, page.name, 0)
    assert doctest.DocTestRunner().run(examples).failed == 0, capsys.readouterr().out
