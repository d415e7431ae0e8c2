"""The documentation's source: every chapter is listed, every public name has its place.

`.ci/run` builds the site, without a warning.
"""

from __future__ import annotations

import re

import pytest
from guide import DOCS, chapters

import impact88

API = DOCS / "api"
DOCUMENTED = re.compile(r"^\.\. auto(?:function|class|exception):: (\w+)$", re.M)


def groups() -> dict[str, list[str]]:
    """Title -> names, as the docstring of the package groups them; "" for those at its end."""
    named: dict[str, list[str]] = {}
    for paragraph in (impact88.__doc__ or "").split("\n\n"):
        lines = paragraph.split("\n")
        title = "" if lines[0].startswith(" ") else lines.pop(0)
        entries = [re.match(r" {4}(\S.*?)(?: {2,}|$)", line) for line in lines]
        names = ", ".join(entry[1] for entry in entries if entry)
        if names:
            named[title] = names.split(", ")
    return named


GROUPS = groups()


def test_the_package_names_all_it_offers() -> None:
    names = [name for group in GROUPS.values() for name in group]
    assert sorted(names) == sorted(set(impact88.__all__) - {"__version__"})
    assert len(GROUPS) == 4


@pytest.mark.parametrize("title", [title for title in GROUPS if title])
def test_a_group_of_names_has_its_page(title: str) -> None:
    pages = {page.read_text("utf-8").split("\n")[0]: page for page in API.glob("*.rst")}
    text = pages[title].read_text("utf-8")
    block = re.search(r"^\.\. autosummary::\n   :nosignatures:\n\n((?:   \w+\n)+)", text, re.M)
    assert block is not None
    assert sorted(block[1].split()) == sorted(GROUPS[title])
    assert sorted(DOCUMENTED.findall(text)) == sorted(GROUPS[title])


def test_other_names_stand_on_one_page() -> None:
    text = (API / "names.rst").read_text("utf-8")
    assert [name for name in GROUPS[""] if not re.search(rf"\b{name}\b", text)] == []


def test_the_guide_lists_every_chapter() -> None:
    assert sorted(chapters()) == sorted((DOCS / "guide").glob("*.md"))


def test_the_citation_names_chapter_and_version() -> None:
    text = " ".join((DOCS / "cite.md").read_text("utf-8").replace("\n> ", " ").split())
    assert 'Raymond M. Brach, "Vehicle Collision Analysis"' in text
    assert "The impact88 developers, *impact88*, version {{ version }}" in text
