"""An office's copy of the listing: compiled or emulated it prints the same; what is no copy."""

from __future__ import annotations

import re
from pathlib import Path

import captures
import pytest

from impact88.errors import UserError
from impact88.files import packaged_text
from impact88.names import SCENE
from impact88.program.copies import ListingCopy
from impact88.program.replay import replay
from impact88.program.run import run
from impact88.program.scene import sample

LISTING = packaged_text("impact88.legacy", "impact.bas")
SCENES = [case["scene"] for case in captures.scenes()[::200]]
COLUMNS = {name: [scene[name] for scene in SCENES] for name in SCENE}


def line(number: int) -> str:
    """Return a line of the listing."""
    return re.findall(rf"(?m)^{number} .*$", LISTING)[0]


def with_lines(*lines: tuple[int, str]) -> str:
    """Return the listing with other statements in some lines."""
    text = LISTING
    for number, statements in lines:
        text = text.replace(line(number), f"{number} {statements}")
    return text


def with_statements(number: int, statements: str) -> str:
    """Return the listing with statements added to a line."""
    return LISTING.replace(line(number), f"{line(number)}: {statements}")


def with_names(names: dict[str, str]) -> str:
    """Return the listing with other names of variables, texts unchanged."""
    parts = re.split(r'(".*?"| REM .*)', LISTING)
    for k in range(0, len(parts), 2):
        parts[k] = re.sub(r"[A-Z][A-Z0-9]*", lambda m: names.get(m[0], m[0]), parts[k])
    return "".join(parts)


def with_rounding(number: int) -> str:
    """Return the listing with results of a line rounded to the nearest."""
    return LISTING.replace(line(number), re.sub(r"\)\) /", ") + .5) /", line(number)))


COMPILED = {
    "the listing": LISTING,
    "rounded": with_rounding(760),
    "pi": LISTING.replace("3.14159265", "3.1416"),
    "data": with_lines((280, "E = .1:MU = .5:EM = - 1"), (350, "LET N = 6: LET M = 6")),
    "READ": with_lines(
        (280, "READ E,MU,EM: DATA .1,.5,-1"),
        (290, "READ DA,DB,GA,PA,PB,TA,TB"),
        (310, "READ MA,MB,IA,IB: DATA 1,2,3,4,5,6,7,100,90,2000,1000"),
    ),
    "INPUT": with_lines((280, 'INPUT "E,MU,EM ";E,MU,EM'), (310, "INPUT MA,MB: INPUT IA,IB")),
    "order": with_lines((730, line(740)[4:]), (740, line(730)[4:])),
    "80 columns": with_statements(610, 'PRINT CHR$ (9);"80N"'),
    "functions": with_statements(
        620, "PRINT SQR (MA); ATN (UY / MA); TAN (GA); LOG (MB); EXP (-E); SGN (UX)"
    ),
    "products": LISTING.replace("UX ^ 2", "UX * UX"),
    "no pivoting": with_lines((1090, "IF RO > I THEN 1110")),
    "loop too long": with_lines((1020, "FOR RO = 1 TO M + 1: IF RO = I THEN 1060")),
    "sign": LISTING.replace("2 * EM - 1", "2 * EM + 1"),
    "number after IF": with_lines((510, "IF MU > - 10 THEN MU = .5: GOTO 530")),
    "texts": with_lines((720, 'Q$ = "***" + "**": PRINT : PRINT Q$;R$')),
    "converted": with_lines((210, "INPUT S1,S2,WA:UX = S1 * 1.46667:UY = S2 * 1.46667")),
    "weights": with_lines((310, "INPUT W1,W2:MA = W1 / 32.2:MB = W2 / 32.2:IA = 3728:IB = 1961")),
    "RETURN within a loop": with_lines((1150, "A(I,OL) = A(I,OL) / AP: IF OL > M THEN RETURN"))
    + "1155 NEXT OL: RETURN\n",
}
"""Copies that compile."""
EMULATED = {
    "slot 3": LISTING.replace('"PR# " + "0"', '"PR# " + "3"'),
    "speed": with_lines((610, "SPEED= 255: PRINT")),
    "ON": with_lines((510, "ON (MU > - 10) + 1 GOTO 520,530")),
    "columns": with_lines((720, 'PRINT TAB( 5);"*****","*****"')),
    "STEP": with_lines((1020, "FOR RO = M TO 1 STEP - 1: IF RO = I THEN 1060")),
    "two texts": with_lines((720, 'Q$ = "***":R$ = Q$ + "**": PRINT R$')),
    "another array": with_statements(700, "BR(1) = XA"),
    "RND": with_statements(620, "X = RND (1)"),
}
"""Copies that only the emulator runs."""


def copy_of(text: str, folder: Path) -> ListingCopy:
    path = folder / "office.bas"
    path.write_text(text, "utf-8")
    return ListingCopy(str(path))


@pytest.mark.parametrize("name", [*COMPILED, *EMULATED])
def test_pages_are_those_of_the_emulator(name, tmp_path):
    copy = copy_of({**COMPILED, **EMULATED}[name], tmp_path)
    assert (copy.steps is not None) == (name in COMPILED)
    count = len(SCENES) if name in COMPILED else 2
    columns = {name: column[:count] for name, column in COLUMNS.items()}
    assert copy.pages(columns) == [copy.run(scene).printout for scene in SCENES[:count]]


def test_a_scene_replaces_the_copys_numbers(tmp_path):
    for name in ("data", "READ", "INPUT"):
        page = copy_of(COMPILED[name], tmp_path).run(sample(1)).page
        assert page.endswith(run(sample(1)).page[-400:])


def test_the_listing_itself_prints_what_replay_does(tmp_path):
    copy = copy_of(LISTING, tmp_path)
    assert copy.pages(COLUMNS) == replay(COLUMNS, pages=True).pages


def test_small_letters_are_typed_as_capitals(tmp_path):
    scene = sample(1).replaced({"IA": "3.7e3", "UX": "-2.9e1"})
    page = run(scene).page
    assert "IA= 3700" in page
    assert copy_of(LISTING, tmp_path).run(scene).page == page


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "gives no number to E, MU, EM"),
        ("no numbers here", "is not an Applesoft program"),
        (with_names({"UX": "V1", "M": "QQ"}), "gives no number to UX, M; expected"),
        (with_statements(190, 'INPUT "SLOT ";S'), r"asks for S \(INPUT or READ\)"),
        (with_lines((320, "READ KI: DATA 5")), "asks for KI"),
        (with_lines((310, "MA = W1 / W2:MB = 1:IA = 1:IB = 1:W1 = 2:W2 = 3")), "no number to MA"),
    ],
)
def test_what_is_no_copy_is_refused(text, message, tmp_path):
    with pytest.raises(UserError, match=f"office.bas: .*{message}"):
        copy_of(text, tmp_path)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            with_statements(780, "GOTO 780").replace(": END", ""),
            "does not end within 100,000 statements",
        ),
        (with_lines((780, "GOTO 210")), "asks for more than a scene holds"),
    ],
)
def test_a_copy_that_does_not_end(text, message, tmp_path):
    with pytest.raises(UserError, match=f"office.bas: {message}"):
        copy_of(text, tmp_path).run(sample(1))
