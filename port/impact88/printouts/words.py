"""Verdicts in words and as JSON."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from ..version import __version__
from .findings import VERDICTS, Finding, Kind, Verdict, Verification

SCHEMA = "impact88/verify/4"
TITLES = {
    Verdict.IDENTICAL: "IDENTICAL",
    Verdict.AS_READ: "IDENTICAL AS FAR AS READ",
    Verdict.DIFFERS: "DIFFERS",
    Verdict.INCOMPLETE: "INCOMPLETE",
}
SUMMARIES = {
    Verdict.IDENTICAL: (
        "all {count} printed numbers, and all else from the first row to the last, are what the "
        "program prints"
    ),
    Verdict.AS_READ: (
        "what was read exactly of {count} printed numbers is what the program prints; the rest is "
        "listed"
    ),
    Verdict.DIFFERS: "{count} printed numbers compared; the text is not what the program prints",
    Verdict.INCOMPLETE: "too little was read beyond doubt to tell",
}
MISSING = "lines or numbers are missing; everything else is what the program prints"
NO_SCENE = "inputs are missing or were not read; give them with --scene if you know them"
SENTENCES = {
    Kind.NUMBER: "{name} {read}: the program prints {printed}",
    Kind.EITHER: "{name} {read}, or another so listed, would be {printed}",
    Kind.LABEL: "{read} where the program prints {printed!r}",
    Kind.OPEN: "{name} {read}, perhaps misread: the program prints {printed} for what was read",
    Kind.UNREAD: "{name} was not read{instead}{expected}",
    Kind.DOUBT: "{name} read with doubt from {read}: the program prints {printed}",
    Kind.MISREAD: "{read} where the program prints {printed!r}",
    Kind.LOST: "{printed} is missing",
    Kind.FOREIGN: "{read}: the program does not print this",
    Kind.ROW_LOST: "the row {name} is missing",
    Kind.ROW_TWICE: "the row {name} is printed twice",
    Kind.DISORDER: "the row {name} is out of order",
}
MACHINE_READ = "the text given differs; look at the paper: characters of this page were misread"
LONGEST = 60
"""Characters of a text that are quoted."""


def write(
    verification: Verification, file: str = "-", number: int = 1, brief: bool = False
) -> list[str]:
    """Return a verdict in words.

    Parameters
    ----------
    verification : Verification
        The printout with its verdict.
    file : str, default "-"
        The name of its file, "-" for standard input.
    number : int, default 1
        The number of the printout in its file.
    brief : bool, default False
        Leave out the table of numbers, the scene and what the page could not reveal.

    Returns
    -------
    list of str
        Lines.
    """
    name = "standard input" if file == "-" else file
    lines = [
        f"{name}, printout {number} (line {verification.line_of(verification.span[0])}): "
        f"{TITLES[verification.verdict]}",
        f"  {_summary(verification)}",
    ]
    kinds = {finding.kind for finding in verification.findings}
    if verification.verdict is Verdict.DIFFERS and kinds & {Kind.MISREAD, Kind.DOUBT}:
        lines.append("  " + MACHINE_READ)
    if verification.explanation:
        lines.append(f"  explanation: {verification.explanation}")
    lines += [f"  {sentence}" for sentence in _findings(verification)]
    if brief:
        return lines
    if verification.numbers:
        lines += ["", *_table(verification)]
    if verification.scene:
        scene = " ".join(f"{name}={text}" for name, text in verification.scene.items())
        lines += ["", f"  scene as typed: {scene}"]
    if verification.unseen:
        lines += ["", "  Errors this page could not reveal:"]
        lines += [f"  - {sentence}" for sentence in unseen_lines(verification)]
    return lines


def _summary(verification: Verification) -> str:
    """Return the sentence below a verdict."""
    if verification.verdict is Verdict.INCOMPLETE and not verification.scene:
        return NO_SCENE
    is_text = any(finding.read for finding in verification.findings)
    if verification.verdict is Verdict.INCOMPLETE and not is_text:
        return MISSING
    count = sum(bool(number.read) for number in verification.numbers.values())
    return SUMMARIES[verification.verdict].format(count=count)


def _findings(verification: Verification) -> Iterator[str]:
    """Yield a sentence for each finding, the gravest first."""
    for finding in sorted(verification.findings, key=lambda f: [*Kind].index(f.kind)):
        yield f"line {verification.line_of(finding.start)}: {sentence_of(finding)}"


def sentence_of(finding: Finding) -> str:
    """Return what is said of a finding.

    Parameters
    ----------
    finding : Finding
        The finding.

    Returns
    -------
    str
        Part of a sentence, without its place.
    """
    read = " ".join(finding.read.split())
    return SENTENCES[finding.kind].format(
        name=finding.name.replace("REPLY_", "the reply for M"),
        read=repr(read[:LONGEST]),
        printed=finding.printed or "nothing",
        instead=f" ({read[:LONGEST]!r})" if read else "",
        expected=f"; the program prints {finding.printed}" if finding.printed else "",
    )


def _table(verification: Verification) -> Iterator[str]:
    """Yield the table of the numbers as read and as printed."""
    kinds = {finding.name: finding.kind for finding in verification.findings}
    words = {
        Kind.NUMBER: "differs",
        Kind.EITHER: "differs?",
        Kind.OPEN: "open",
        Kind.UNREAD: "not read",
        Kind.DOUBT: "doubt",
    }
    yield f"  {'':5} {'as read':>15} {'the program':>15}"
    for name, number in verification.numbers.items():
        read = " ".join(number.read.split())
        word = words.get(kinds.get(name, Kind.LOST), "")
        yield f"  {name:5} {read:>15} {number.printed:>15}  {word}".rstrip()


def unseen_lines(verification: Verification) -> Iterator[str]:
    """Yield a sentence for each input with digits that nothing else on the page confirms."""
    for name, count in verification.unseen.items():
        text = verification.scene[name]
        digits = sum(map(str.isdigit, text.partition("E")[0]))
        yield (
            f"{name}: nothing else on the page depends on it"
            if count == digits
            else f"{name} = {text}: {count} of its {digits} digits could be others"
        )


def record(
    verification: Verification, file: str = "-", number: int = 1, sha256: str | None = None
) -> dict[str, Any]:
    """Return a verdict as an object of JSON.

    Parameters
    ----------
    verification : Verification
        The printout with its verdict.
    file : str, default "-"
        The name of its file.
    number : int, default 1
        The number of the printout in its file.
    sha256 : str, optional
        The digest of the file.

    Returns
    -------
    dict
        Texts, numbers, lists and dicts, versioned by ``schema``.
    """
    return {
        "schema": SCHEMA,
        "version": __version__,
        "file": file,
        "sha256": sha256,
        "printout": number,
        "line": verification.line_of(verification.span[0]),
        "span": [*verification.span],
        "verdict": verification.verdict.value,
        "scene": dict(verification.scene),
        "numbers": {name: number._asdict() for name, number in verification.numbers.items()},
        "findings": [
            {
                **finding._asdict(),
                "kind": finding.kind.name.lower(),
                "line": verification.line_of(finding.start),
                "sentence": sentence_of(finding),
            }
            for finding in verification.findings
        ],
        "unseen": dict(verification.unseen),
        "explanation": verification.explanation,
    }


def verdict_table() -> str:
    """Return the guide's table of findings and the verdicts that they give, in Markdown."""
    rows = ["| finding | verdict |", "|---|---|", "| none | IDENTICAL |"]
    rows += [f"| {kind.value} | {TITLES[verdict]} |" for kind, verdict in VERDICTS.items()]
    return "\n".join(rows)
