"""README, the guide and the maintainer's README: length, links, files named, the table of names."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from captures import ROOT
from guide import DOCS, chapters

from impact88 import status
from impact88.cli import COMMANDS, GONE
from impact88.names import SCENE

READMES = [ROOT / "README.md", ROOT / "port" / "README.md", ROOT / "tests" / "README.md"]
TASKS = (
    "printout scan intersection rear-end collision edr crush programs program-1988 prompt"
).split()
MAX_LINES = 120
MAX_WORDS = 600  # of a page's prose


def prose(page: Path) -> str:
    """Return a page without its blocks of code."""
    return re.sub(r"^```.*?^```$", "", page.read_text("utf-8"), flags=re.M | re.S)


@pytest.mark.parametrize("page", READMES[:2])
def test_a_readme_is_short(page: Path) -> None:
    assert len(page.read_text("utf-8").splitlines()) <= MAX_LINES


@pytest.mark.parametrize("task", TASKS)
def test_a_page_of_a_task_is_short(task: str) -> None:
    assert len(prose(DOCS / "guide" / f"{task}.md").split()) <= MAX_WORDS


@pytest.mark.parametrize("page", [*READMES, *chapters()], ids=lambda page: page.stem)
def test_links_lead_to_files(page: Path) -> None:
    links = re.findall(r"\]\(([^)#\s]+)", prose(page))
    missing = [x for x in links if "://" not in x and not (page.parent / x).exists()]
    assert not missing


def test_files_that_the_maintainers_readme_names_are_there() -> None:
    text = (ROOT / "port" / "README.md").read_text("utf-8")
    named = re.findall(r"`([A-Za-z0-9_./-]+\.(?:py|md|txt|toml|c|bas))`", text)
    places = [ROOT, ROOT / "port" / "impact88", ROOT / "port" / "docs" / "guide"]
    written = {"measurements.md"}
    missing = [x for x in named if x not in written and not any((p / x).exists() for p in places)]
    assert named
    assert not missing


def test_the_maintainers_readme_shows_every_package() -> None:
    text = (ROOT / "port" / "README.md").read_text("utf-8").partition("| question |")[0]
    packages = {path.parent.name for path in (ROOT / "port" / "impact88").glob("*/__init__.py")}
    assert [name for name in packages if f" {name}/ " not in text] == []


def test_the_table_of_names_is_that_of_the_package() -> None:
    rows = [
        f"| `{q.name}` | {q.symbol} | {q.meaning} | {q.unit} | {q.line} |" for q in SCENE.values()
    ]
    assert "\n".join(rows) in (DOCS / "guide" / "axes.md").read_text("utf-8")


def test_every_command_has_an_example_and_no_page_names_one_that_went() -> None:
    text = "\n".join(page.read_text("utf-8") for page in [READMES[0], *chapters()])
    assert [name for name in COMMANDS if f"impact88 {name}" not in text] == []
    assert [name for name in GONE if re.search(rf"`?impact88 {name}\b", text)] == []


def test_the_bits_of_status_are_those_of_the_code() -> None:
    rows = re.findall(
        r"^\| (\d+) \| `(\w+)` \| (.+) \|$", (DOCS / "guide" / "tables.md").read_text("utf-8"), re.M
    )
    bits = [(str(int(bit)), bit.name, status.WORDS[bit]) for bit in status.Status]
    assert rows == bits
