"""The line table of the port, made from the comments of listing.py.

    python tests/linetable.py

writes port/impact88/program/linetable.py anew; tests/test_listing.py checks that it is this one.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PROGRAM = ROOT / "port" / "impact88" / "program"
COMMENT = r" *# (\d+) (.*)"
ASSIGNED = r"(?:^|:|THEN )\s*([A-Z][A-Z0-9]?) = "
INPUT = r"INPUT ([A-Z0-9,]+)$"
LOOP = r"FOR ([A-Z][A-Z0-9]?) = "

HEAD = '''"""Which BASIC line the Python lines of `listing` translate, and what each line assigns.

Made by tests/linetable.py from the comments of listing.py; not to be edited by hand.
"""

from __future__ import annotations

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
    text = HEAD + f"FIRST_PYTHON_LINE = {first}\n"
    text += '"""Where `listing.impact` begins."""\nLINES = (\n'
    text += "".join(f"    ({place}, {number}),\n" for place, number, _ in lines)
    text += ')\n"""Python line of each comment, and the BASIC line it holds."""\n'
    text += "REALS = (\n" + "".join(f'    "{name}",\n' for name in sorted(reals)) + ")\n"
    text += f"INPUTS = {tuple(inputs)!r}\nASSIGNED: dict[int, tuple[str, ...]] = {{\n"
    for number, names in assigned.items():
        text += f"    {number}: {tuple(names)!r},\n".replace("'", '"')
    return text + '}\n"""The variables each line assigns, in order."""\n'


if __name__ == "__main__":
    (PROGRAM / "linetable.py").write_text(table(), encoding="utf-8")
    sys.stdout.write(f"{PROGRAM / 'linetable.py'} is the table of listing.py now\n")
