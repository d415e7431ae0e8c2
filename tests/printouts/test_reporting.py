"""`impact88 verify` on files as people have them, and with the inputs apart (``--scene``)."""

from __future__ import annotations

import html
import json
from pathlib import Path

import pytest
from installed import impact88
from longer import long_but

from impact88.collision.casescene import sample
from impact88.collision.doubles import double
from impact88.printouts.judging.judgement import FieldCheck, Status
from impact88.printouts.reading.printout import read_printouts
from impact88.printouts.reporting.examination import Verdict, Verification, verify
from impact88.printouts.reporting.verification import summary
from impact88.program.run import run
from printouts import SAMPLE, SWEEP

ROW = " PA PB TA TB GA\n -19.8      -38.7      0      60      -30"
ANGLES = dict(
    zip(("PA", "PB", "TA", "TB", "GA"), ("-19.8", "-38.7", "0", "60", "-30"), strict=True)
)
PAIRS = [
    tuple(part.split("="))
    for part in SAMPLE.replace(ROW, " ".join(f"{name}={text}" for name, text in ANGLES.items()))
    .replace("INITIAL KE", "INITIALKE").replace("KE LOSS", "KELOSS").replace("*****", "")
    .replace("= ", "=").replace("(", " ").replace(")", " ").replace("%", " ").split()
]  # fmt: skip
EXACT, AS_READ = "identical", "identical_as_read"
FORMS: dict[str, tuple[str | bytes, str]] = {
    "decimal-commas.txt": (SAMPLE.replace(".", ","), AS_READ),
    "thousands.txt": (
        SAMPLE.replace("100904.929", "100,904.929").replace("3728", "3,728"), AS_READ
    ),
    "thousands-and-commas.txt": (
        SAMPLE.replace("3728", "3 728").replace(".", ",").replace("3 728", "3.728")
        .replace("100904,929", "100.904,929"),
        AS_READ,
    ),
    "colons.txt": (SAMPLE.replace("=", ":"), EXACT),
    "powers.txt": (SAMPLE.replace("5E-03", "5×10⁻³"), AS_READ),
    "carets.txt": (SAMPLE.replace("5E-03", "5 x 10^-3"), AS_READ),
    "numbered.txt": (
        "\n".join(f"{row}  {line}" for row, line in enumerate(SAMPLE.split("\n"), 1)), EXACT
    ),
    "tens.txt": (
        "".join(f"{row}0: {line}\n" for row, line in enumerate(filter(None, SAMPLE.split("\n")))),
        EXACT,
    ),
    "no-marks.txt": (SAMPLE.replace("=", ""), EXACT),
    "angles.txt": (SAMPLE.replace(ROW, "\n".join(f"{n}: {t}" for n, t in ANGLES.items())), EXACT),
    "table.md": (
        "| name | value |\n|---|---|\n" + "".join(f"| {n} | {t} |\n" for n, t in PAIRS), EXACT
    ),
    "table.csv": ("name,value\n" + "".join(f"{n},{t}\n" for n, t in PAIRS), EXACT),
    "quoted.csv": (
        '"name";"value"\r\n' + "".join(f'"{n}";"{t}"\r\n' for n, t in PAIRS), EXACT
    ),
    "tabs.txt": ("".join(f"{n}\t{t}\n" for n, t in PAIRS), EXACT),
    "mail.txt": ("Dear all,\n" + "".join(f">> {line}\n" for line in SAMPLE.split("\n")), EXACT),
    "entities.txt": (SAMPLE.replace(" ", "&nbsp;"), EXACT),
    "page.html": (f"<html><body><pre>{html.escape(SAMPLE)}</pre></body></html>", EXACT),
    "page.rtf": (
        "{\\rtf1\\ansi {\\f0\\fmodern Courier;}\n"
        + "".join(f"{line}\\par\n" for line in SAMPLE.split("\n")) + "}", EXACT
    ),
    "windows.txt": (("Caf\u00e9 \u2013\n" + SAMPLE.replace("-", "\u2013")).encode("cp1252"), EXACT),
    "macintosh.txt": (
        ("Caf\u00e9\n" + SAMPLE.replace("-", "\u2013")).replace("\n", "\r").encode("mac_roman"),
        EXACT,
    ),
    "apple.txt": (bytes(byte | 0x80 for byte in SAMPLE.replace("\n", "\r").encode()), EXACT),
    "wide.txt": (SAMPLE.encode("utf-16"), EXACT),
}  # fmt: skip
"""What people type and paste -> the verdict: exact where every number stands as it is printed."""
NO_TEXT = {
    "scan.pdf": (b"%PDF-1.4\n" + b"x" * 900, "is not a PDF that can be read"),
    "scan.png": (b"\x89PNG\r\n\x1a\n" + b"\0" * 900, "picture"),
    "scan.jpg": (b"\xff\xd8\xff\xe0" + b"\0" * 900, "picture"),
    "page.docx": (b"PK\x03\x04" + b"\0" * 900, "plain text"),
    "page.doc": (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + b"\0" * 900, "antiword"),
}
"""Files that are not text -> what their one line tells to use."""


def written(folder: Path, files: dict[str, tuple[str | bytes, str]]) -> list[str]:
    paths = []
    for name, (content, _) in files.items():
        data = content.encode() if isinstance(content, str) else content
        (folder / name).write_bytes(data)
        paths.append(str(folder / name))
    return paths


@pytest.mark.long
def test_what_people_paste(tmp_path: Path) -> None:
    assert len(PAIRS) == 36
    done = impact88("verify", "--json", *written(tmp_path, FORMS))
    objects = [json.loads(line) for line in done.stdout.splitlines()]
    verdicts = {Path(one["file"]).name: one["verdict"] for one in objects}
    assert verdicts == {name: verdict for name, (_, verdict) in FORMS.items()}
    assert len(objects) == len(FORMS)
    assert done.returncode == 1
    assert done.stderr == ""


def test_angles_may_stand_one_below_the_other() -> None:
    text, _ = FORMS["angles.txt"]
    assert verify(read_printouts(text)[0]).verdict is Verdict.IDENTICAL


def test_files_that_are_no_text_get_one_line_each(tmp_path: Path) -> None:
    done = impact88("verify", *written(tmp_path, NO_TEXT))
    assert done.returncode == 2
    assert done.stdout == ""
    lines = done.stderr.splitlines()
    assert len(lines) == len(NO_TEXT)
    for line, (name, (_, remedy)) in zip(lines, NO_TEXT.items(), strict=True):
        assert name in line
        assert remedy in line


# --- the inputs apart ----------------------------------------------------------------------------

RESULTS = SAMPLE[SAMPLE.index("INITIAL") :]


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    path = tmp_path / "scene.toml"
    path.write_text("\n".join(f'{name} = "{text}"' for name, text in sample(1).items()))
    return path


def apart(folder: Path, page: str, scene: Path) -> tuple[dict, str, int]:
    (folder / "results.txt").write_text(page)
    done = impact88("verify", "--json", str(folder / "results.txt"), "--scene", str(scene))
    one = json.loads(done.stdout) if done.stdout else {}
    return one, done.stderr, done.returncode


def test_results_alone_with_their_scene(tmp_path: Path, scene: Path) -> None:
    one, _, status = apart(tmp_path, RESULTS, scene)
    assert (one["verdict"], status) == ("incomplete", 1)
    assert one["missing"] == []
    read = [check for check in one["fields"] if check["printed"] is not None]
    assert len(read) == 12
    assert all(check["same"] for check in read)
    assert any(
        "all 12 numbers read are what the program prints" in line for line in one["findings"]
    )


def test_results_alone_with_another_scene(tmp_path: Path, scene: Path) -> None:
    scene.write_text(scene.read_text().replace('"143.5"', '"243.5"'))
    one, _, status = apart(tmp_path, RESULTS, scene)
    assert (one["verdict"], status) == ("differs", 1)
    assert any("not what it prints" in line for line in one["findings"])


SLIPS = [
    ("PA", "+19.8"), ("E", "0.005E1"), ("MU", "-.911"), ("TB", "90"), ("UX", " 29.04"),
    ("MA", "134.5"), ("MB", "98.8"), ("IB", "1961.0E1"), ("DA", "+75.9"), ("GA", "-33"),
    ("VY", "25.51"), ("MU", "9.11"), ("EM", "-.775"), ("IA", "3827"), ("E", "6e-3"),
    ("UX", "- 29.94"),
]  # fmt: skip


@pytest.mark.parametrize(
    ("name", "typed", "noise"),
    long_but([(*slip, noise) for slip in SLIPS for noise in (False, True)][:: 1 if SWEEP else 8]),
)
def test_a_slip_in_what_was_given_apart_is_found(name: str, typed: str, noise: bool) -> None:
    """And no reader's mistake is made of it, however bad the scan of the results is."""
    true = dict(sample(1).items())
    page = RESULTS.replace("*****", "KKKKK").replace("INITIAL", "1NITIAL") if noise else RESULTS
    (shown,) = read_printouts(page)
    result = verify(shown, given={**true, name: typed})
    assert result.verdict is Verdict.DIFFERS
    said = [
        {change["field"]: double(change["would_be"]) for change in one.changes}
        for one in result.explanations
        if one.rank == 1 and one.note == "in the inputs given separately"
    ]
    field = "MUP" if name == "MU" else name
    assert any(
        changes.keys() == {field} and abs(changes[field]) == abs(double(true[name]))
        for changes in said
    ), result.explanations


def test_scenes_given_apart_otherwise_than_the_page_has_them() -> None:
    """The page counts, and that the scene is another is said."""
    (shown,) = read_printouts(SAMPLE)
    true = dict(sample(1).items())
    same = {**true, "DA": "7.590", "PA": " - 19.8", "MU": "+.911", "E": "5E-3", "UY": "-0"}
    assert not any("given separately" in line for line in verify(shown, given=same).findings)
    result = verify(shown, given={**same, "MA": "143.51", "PA": "+19.8", "MU": "-.911"})
    assert result.verdict is Verdict.IDENTICAL
    (line,) = [line for line in result.findings if "given separately" in line]
    assert line.endswith(
        "MA 143.51 (by the page 143.5); PA +19.8 (by the page -19.8); MU -.911 (by the page .911)"
    )


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ('MA = "143.5"', "", "missing MA (mass of A)"),
        ('"143.5"', '"much"', "MA = 'much' is not a number"),
        ("MA =", "MA = =", "line "),
    ],
)
def test_a_scene_that_cannot_be_used(
    tmp_path: Path, scene: Path, old: str, new: str, says: str
) -> None:
    scene.write_text(scene.read_text().replace(old, new))
    one, stderr, status = apart(tmp_path, RESULTS, scene)
    assert (one, status) == ({}, 2)
    assert stderr.count("\n") == 1
    assert "scene.toml" in stderr
    assert says in stderr


# --- sentences ------------------------------------------------------------------------------------

FAINT = dict(
    zip(
        "MA MB IA IB DA DB PA PB TA TB GA UX UY WA VX VY WB E MU EM".split(),
        "3.1666 834095 1.604 485972 .0261 53.634 -58 -115.8 0 144 -52 364.8449 -.0494 0 1.0635 "
        "-1.07436 0 .16 -.22 -.953".split(),
        strict=True,
    )
)
"""A light vehicle against a heavy one: the last digits of IB, DB and UY show in no result."""


def test_a_digit_repeated_at_the_prompt_is_not_called_one_that_cannot_show() -> None:
    page = run({**FAINT, "M": "6"}).printout
    body = page[page.index("MA=", page.rindex("?")) :]
    of_page, of_body = (verify(text.encode())[0].unseen[-1] for text in (page, body))
    assert "IB 485(972)" in of_page
    assert "IB 485(972)" in of_body
    assert "UY" not in of_page
    assert "UY -.049(4)" in of_body
    (altered,) = verify(page.replace("UY= -.0494", "UY= -.0493").encode())
    assert altered.verdict is Verdict.DIFFERS
    assert not altered.differing
    said = " ".join(summary(altered))
    assert "the reply at the prompt and the row of velocities do not agree" in said


def test_lines_that_are_not_the_programs_are_counted() -> None:
    (result,) = verify((SAMPLE + "\nDELTA-V A= 41.27 MPH\n").encode())
    assert result.verdict is Verdict.IDENTICAL_AS_READ
    assert "1 line on the page is not the program's: see below" in summary(result)
    assert not any("not the program's:" in said for said in summary(verify(SAMPLE.encode())[0]))


@pytest.mark.parametrize("printed", ["-33.4", None])
def test_an_incomplete_page_says_what_does_not_agree(printed: str | None) -> None:
    """A reply at a prompt is named; an angle that the page shows is not called missing."""
    fields = [FieldCheck("PA", printed, None), FieldCheck("UX", "-74.8898002", "-74.8898002")]
    fields[1].status = Status.READ
    replies = [FieldCheck("UX", "-74.8898", "-74.8898001", Status.CONTRADICTED)]
    missing = [] if printed is None else ["PA"]
    result = Verification(
        "x.txt", 1, 1, Verdict.INCOMPLETE, {}, fields, replies=replies, missing=missing
    )
    said = summary(result)
    assert said[0] == (
        "UX: the reply at the prompt is -74.8898, and the row of velocities has -74.8898002"
    )
    assert not any("the results are missing" in sentence for sentence in said)
    assert any("PA is not certain as read" in sentence for sentence in said) is bool(missing)
