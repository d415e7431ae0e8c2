"""The line table of the port, made from the comments of listing.py.

    python tests/support/linetable.py

writes port/impact88/program/linetable.py anew; tests/program/test_listing.py checks that it is this
one.
"""

from __future__ import annotations

import re
import sys
import textwrap
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "port" / "impact88" / "program"
COMMENT = r" *# (\d+) (.*)"
ASSIGNED = r"(?:^|:|THEN )\s*([A-Z][A-Z0-9]?) = "
INPUT = r"INPUT ([A-Z0-9,]+)$"
LOOP = r"FOR ([A-Z][A-Z0-9]?) = "

HEAD = '''"""Which BASIC line the Python lines of `listing` translate, and what each line assigns.

Made by tests/support/linetable.py from the comments of listing.py; not to be edited by hand.
"""

FIRST_PYTHON_LINE = {first}
"""The line of ``listing.py`` at which `listing.impact` begins."""
_PYTHON = """
{PYTHON_LINES}
"""
_BASIC = """
{BASIC_LINES}
"""
PYTHON_LINES = tuple(map(int, _PYTHON.split()))
BASIC_LINES = tuple(map(int, _BASIC.split()))
"""The Python line of each comment, and the number of the BASIC line it holds."""
REALS = """
{REALS}
""".split()
INPUTS = {inputs}
"""The lines of INPUT."""
_ASSIGNED = """
{ASSIGNED}
"""
ASSIGNED = {{int(line): names for line, *names in map(str.split, _ASSIGNED.split(";"))}}
"""The variables each line assigns, in order."""
'''


def comments() -> list[tuple[int, int, str]]:
    """Python line, BASIC line and text of every comment in listing.py that holds BASIC."""
    lines = (PROGRAM / "listing.py").read_text(encoding="utf-8").splitlines()
    matches = ((place, re.match(COMMENT, text)) for place, text in enumerate(lines, 1))
    return [(place, int(m[1]), m[2]) for place, m in matches if m]


def table() -> str:
    """The text of linetable.py."""
    source = (PROGRAM / "listing.py").read_text(encoding="utf-8").splitlines()
    first = next(n for n, line in enumerate(source, 1) if line.startswith("def impact("))
    lines = comments()
    assigned: dict[int, list[str]] = {}
    reals: set[str] = set()
    inputs = []
    for _, number, text in lines:
        if re.match("REM", text):
            continue
        match = re.match(INPUT, text)
        names = match[1].split(",") if match else re.findall(ASSIGNED, text)
        if match:
            inputs.append(number)
        if names:
            assigned[number] = names
        reals |= {*names, *re.findall(LOOP, text)}
    words = {
        "PYTHON_LINES": " ".join(str(place) for place, _, _ in lines),
        "BASIC_LINES": " ".join(str(number) for _, number, _ in lines),
        "REALS": " ".join(sorted(reals)),
        "ASSIGNED": "; ".join(" ".join((str(n), *names)) for n, names in assigned.items()),
    }
    filled = {name: "\n".join(textwrap.wrap(text, 96)) for name, text in words.items()}
    return HEAD.format(first=first, inputs=tuple(inputs), **filled)


if __name__ == "__main__":
    (PROGRAM / "linetable.py").write_text(table(), encoding="utf-8")
    sys.stdout.write(f"{PROGRAM / 'linetable.py'} is the table of listing.py now\n")
