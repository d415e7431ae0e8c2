"""The guide's chapters, in the order in which it lists them."""

from __future__ import annotations

import re
from pathlib import Path

from captures import ROOT

DOCS = ROOT / "port" / "docs"


def listed(page: Path) -> list[str]:
    """The pages that a page's toctree lists."""
    (toctree,) = re.findall(r"^```\{toctree\}\n(.*?)^```$", page.read_text("utf-8"), re.M | re.S)
    return [line for line in toctree.splitlines() if line and not line.startswith(":")]


def chapters() -> list[Path]:
    """The guide's files: its first page, then the chapters."""
    first = DOCS / "guide" / "index.md"
    return [first, *(first.with_name(f"{name}.md") for name in listed(first))]


def guide() -> str:
    """The text of the whole guide."""
    return "\n".join(path.read_text("utf-8") for path in chapters())
