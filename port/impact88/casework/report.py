"""The report: verdicts on printouts as one self-contained page for a case file.

No script, no font and no picture from elsewhere; the scene is drawn in the page. Every printout
starts a new sheet and fits one of A4 or Letter, longer explanations aside.
"""

from __future__ import annotations

import string
from collections.abc import Mapping, Sequence
from html import escape

from .. import files, names
from ..errors import UserError
from . import beside, provenance
from .verify import FieldCheck, Verdict, Verification

_SAYS = {
    Verdict.IDENTICAL: "Every number compared is what the 1988 program prints, digit for digit.",
    Verdict.DIFFERS: "The 1988 program does not print this for the scene the printout shows.",
    Verdict.INCOMPLETE: "What could be compared agrees; numbers are missing or illegible.",
}

_PAGE = string.Template("""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>$title</title>
<style>
@page { margin: 12mm 15mm; }
* { box-sizing: border-box; }
body { font: 9.5pt/1.35 "Helvetica Neue", Helvetica, Arial, "Liberation Sans", sans-serif;
  color: #1a1a1a; background: #fff; max-width: 180mm; margin: 8mm auto; }
h1 { font-size: 15pt; margin: 0 0 1mm; }
h2 { font-size: 10.5pt; margin: 3mm 0 1.2mm; border-bottom: .3mm solid #999; }
section { break-after: page; }
section:last-of-type { break-after: auto; }
.source { color: #444; margin: 0 0 2.5mm; overflow-wrap: anywhere; }
.verdict { border: .4mm solid; border-left-width: 3mm; padding: 1.8mm 3mm; margin: 0 0 3mm; }
.verdict b { font-size: 12pt; text-transform: uppercase; letter-spacing: .06em; }
.identical { border-color: #00664b; } .differs { border-color: #a33c00; }
.incomplete { border-color: #5b5b5b; }
.two { display: flex; gap: 4mm; align-items: flex-start; }
.two > .numbers { flex: 1 1 auto; } .two > .picture { flex: 0 0 66mm; }
.picture svg { width: 100%; height: auto; max-height: 88mm; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
.numbers table { width: 100%; font-size: 8pt; line-height: 1.18; }
th, td { text-align: right; padding: .12mm .9mm; vertical-align: top; white-space: nowrap; }
th { border-bottom: .2mm solid #999; font-weight: 600; }
td:first-child, th:first-child { text-align: left; }
tr.new td { border-top: .1mm solid #ccc; }
tr.differs td { background: #fbe3d6; font-weight: 700; }
tr.unknown td { color: #666; font-style: italic; }
.picture table { font-size: 8pt; line-height: 1.22; width: 100%; }
.picture td { text-align: left; } .picture td:nth-child(even) { padding-right: 3mm; }
.picture ol { font-size: 8.5pt; }
ol, ul { margin: 0; padding-left: 5mm; } li { margin-bottom: .4mm; font-size: 8.5pt; }
.provenance { font-size: 7.5pt; color: #333; }
.provenance td { white-space: normal; overflow-wrap: anywhere; text-align: left; }
.provenance td:first-child { white-space: nowrap; padding-right: 4mm; }
tr, li, .verdict { break-inside: avoid; }
h2 { break-after: avoid; }
@media print { body { margin: 0 auto; } .verdict, tr.differs td {
  -webkit-print-color-adjust: exact; print-color-adjust: exact; } }
</style>
</head>
<body>
$sections
</body>
</html>
""")


def write_report(path: str, results: Sequence[Verification], date: str | None = None) -> None:
    """Write the page for ``results`` to ``path``, whole or not at all. Raises UserError."""
    page = report(results, date)
    with files.replacing(path) as file:
        file.write(page)


def report(results: Sequence[Verification], date: str | None = None) -> str:
    """The page as HTML. ``date`` is the user's own, shown as given."""
    hashes = {result.file: _file_hash(result.file) for result in results}
    sections = [_section(result, hashes[result.file], date) for result in results]
    title = f"Verification of {len(results)} printout{'s' if len(results) > 1 else ''}"
    return _PAGE.substitute(title=title, sections="\n".join(sections))


def _file_hash(path: str) -> str:
    if path == "-":
        return "read from standard input"
    try:
        return provenance.sha256(files.read_bytes(path))
    except UserError:
        return "no longer readable"


def _section(result: Verification, file_hash: str, date: str | None) -> str:
    where = "standard input" if result.file == "-" else result.file
    verdict = result.verdict
    parts = [
        "<section>",
        "<h1>Verification of a printout</h1>",
        f'<p class="source">{escape(where)}, printout {result.number} (line {result.line})'
        f"{', ' + escape(date) if date else ''}</p>",
        f'<div class="verdict {verdict}"><b>{verdict}</b><br>{escape(_SAYS[verdict])} '
        f"{escape(_counts(result))}</div>",
        '<div class="two"><div class="numbers">',
        _numbers(result.fields),
        "</div>",
        f'<div class="picture">{_drawing(result)}{_scene(result.scene)}',
        f"{_explanations(result)}</div></div>",
        _beside(result),
        _notes(result),
        _provenance(file_hash, date),
        "</section>",
    ]
    return "\n".join(part for part in parts if part)


def _counts(result: Verification) -> str:
    compared = sum(check.same is not None for check in result.fields)
    text = f"{compared} numbers compared, {len(result.differing)} differ."
    if result.missing:
        text += f" Missing: {', '.join(result.missing)}."
    ending = result.ending
    if ending and (ending.printed or ending.recomputed):
        text += f" Ends with: {ending.printed or 'nothing'}"
        text += "." if ending.same else f"; recomputed: {ending.recomputed or 'no error'}."
    return text


def _numbers(checks: Sequence[FieldCheck]) -> str:
    from ..fields import FIELDS

    rows = [
        "<table><thead><tr><th>field</th><th>printed</th><th>recomputed</th><th>exact</th>"
        "<th>printed − exact</th></tr></thead><tbody>"
    ]
    line = 0
    for check in checks:
        kinds = ["differs"] if check.same is False else ["unknown"] if check.same is None else []
        if FIELDS[check.name].line != line:
            line = FIELDS[check.name].line
            kinds.append("new")
        cells = (
            check.name,
            check.printed or "–",
            check.recomputed or "–",
            check.exact or "",
            (check.difference or "").replace("-", "−"),
        )
        row = "".join(f"<td>{escape(cell)}</td>" for cell in cells)
        rows.append(f'<tr class="{" ".join(kinds)}">{row}</tr>')
    return "\n".join([*rows, "</tbody></table>"])


def _drawing(result: Verification) -> str:
    if not result.runnable:
        return ""
    from ..figures.sceneview import scene_svg

    scene = {name: text for name, text in result.scene.items() if text is not None}
    try:
        outcome = beside.solved(scene, [*names.FINAL_VELOCITIES, "STATUS"])
        return scene_svg(scene, outcome)
    except (UserError, ValueError):
        return "<p>(The scene cannot be drawn.)</p>"


def _scene(scene: Mapping[str, str | None]) -> str:
    """The scene as a grid, three values a row, in the order of the listing's lines."""
    cells = [
        f"<td>{name}</td><td>{escape(text) if text is not None else '<b>missing</b>'}</td>"
        for name, text in scene.items()
    ]
    rows = "".join(f"<tr>{''.join(cells[at : at + 3])}</tr>" for at in range(0, len(cells), 3))
    return f"<h2>Scene recovered</h2><table>{rows}</table>"


def _explanations(result: Verification) -> str:
    if not result.explanations:
        return ""
    items = []
    for one in result.explanations:
        text = escape(one.kind)
        if one.field:
            text += f": {escape(one.field)} {escape(one.printed or '')}"
            text += f", would be <b>{escape(one.would_be or '')}</b>"
        text += f"; explains {one.explains} of {result.disagreements}"
        if one.note:
            text += f" ({escape(one.note)})"
        items.append(f"<li>{text}</li>")
    return f"<h2>Explanations, tested by replay</h2><ol>{''.join(items)}</ol>"


def _beside(result: Verification) -> str:
    if not result.warnings:
        return ""
    items = "".join(f"<li>{escape(warning)}</li>" for warning in result.warnings)
    return f"<h2>Beside the verdict</h2><ul>{items}</ul>"


def _notes(result: Verification) -> str:
    notes = [
        f"{row['name']} {row['printed']}: fits " + (", ".join(row["fits"]) or "nothing")
        for row in result.illegible
    ]
    notes += [
        f"the reply {check.printed} for {check.name} is not the {check.recomputed} used"
        for check in result.replies
        if check.same is False
    ]
    notes += result.remarks
    if not notes:
        return ""
    return (
        f"<h2>Notes on the reading</h2><ul>{''.join(f'<li>{escape(n)}</li>' for n in notes)}</ul>"
    )


def _provenance(file_hash: str, date: str | None) -> str:
    versions = provenance.versions()
    rows = {
        "program": f"impact88 {versions['impact88']}, {versions['python']}",
        "printout, SHA-256": file_hash,
        "listing, SHA-256": provenance.listing_hash(),
        "captures, SHA-256": provenance.captures_hash(),
        "date": f"{date} (as given)" if date else "not given",
    }
    cells = "".join(
        f"<tr><td>{escape(name)}</td><td>{escape(text)}</td></tr>" for name, text in rows.items()
    )
    method = (
        "Recomputed: the 1988 listing, replayed bit for bit in Applesoft's 40-bit arithmetic, "
        "checked against captures of a real Apple II Plus ROM. Exact: Equations 13 to 18 in double "
        "precision; it does not bear on the verdict."
    )
    return f'<div class="provenance"><h2>Provenance</h2><table>{cells}</table><p>{method}</p></div>'
