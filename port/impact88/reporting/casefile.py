"""The report: verdicts on printouts as one self-contained page for a case file.

No script, no font and no picture from elsewhere; the scene is drawn in the page. First a sheet with
all files, those that could not be read included, and room for a signature; then every printout from
a sheet of its own: verdict, numbers, the text as it was read with every doubtful place marked, the
recovered inputs, explanations, and what the page cannot show.
"""

from __future__ import annotations

import string
from collections.abc import Iterator, Sequence
from html import escape

from .. import files
from ..errors import UserError
from ..explaining.explanations import NO_SINGLE_SLIP
from ..fields import FIELDS
from ..judging import beside
from ..judging.judgement import Doubtful, FieldCheck, Status, Verdict
from ..names import FINAL_VELOCITIES, quantity
from ..reading.fieldlabels import LabelState
from . import provenance, verification, wording
from .examination import Examined, Verification

_MARKS = {
    Status.READ: ("", "✓", "exact"),
    Status.DOUBTFUL: ("doubtful", "?", "doubtful"),
    Status.CONTRADICTED: ("differs", "≠", "differs"),
    Status.NOT_READ: ("unknown", "–", "not read"),
    Status.NOT_COMPARED: ("unknown", "–", "not compared"),
}
"""How a number's row is shown: class, sign, word."""

_LAY = {
    Verdict.IDENTICAL: "Every number on this page was read without doubt, and each is exactly what "
    "the 1988 program prints for the collision the page describes.",
    Verdict.IDENTICAL_AS_READ: "The page agrees with what the 1988 program prints, as far as it "
    "could be read. Some characters were not read for certain: each is marked below, and should be "
    "looked at on the paper itself.",
    Verdict.DIFFERS: "At least one number or label on this page is not what the 1988 program "
    "prints for the collision the page describes. Which, and what may explain it, is told below.",
    Verdict.INCOMPLETE: "Numbers are missing from this page or could not be read, so that it "
    "cannot be said whether it is what the 1988 program prints.",
}

_PAGE = string.Template("""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>$title</title>
<style>
@page { margin: 13mm 15mm; }
* { box-sizing: border-box; }
:root { color-scheme: light; }
body { font: 9.5pt/1.38 "Helvetica Neue", Helvetica, Arial, "Liberation Sans", sans-serif;
  color: #1a1a1a; background: #fff; max-width: 180mm; margin: 8mm auto; padding: 0 3mm; }
h1 { font-size: 15pt; margin: 0 0 1mm; }
h2 { font-size: 10.5pt; margin: 4mm 0 1.4mm; border-bottom: .3mm solid #999; }
section { break-after: page; margin-bottom: 12mm; }
section:last-of-type { break-after: auto; }
.source { color: #444; margin: 0 0 2.5mm; overflow-wrap: anywhere; }
.verdict { border: .4mm solid; border-left-width: 3mm; padding: 1.8mm 3mm; margin: 0 0 3mm; }
.verdict b { font-size: 12pt; letter-spacing: .05em; }
.verdict p { margin: .8mm 0 0; }
.identical { border-color: #00664b; } .identical_as_read { border-color: #1f5f8b; }
.differs { border-color: #a33c00; } .incomplete, .unreadable { border-color: #5b5b5b; }
.two { display: flex; gap: 5mm; align-items: flex-start; }
.two > .numbers { flex: 1 1 auto; } .two > .picture { flex: 0 0 52mm; }
.picture svg { width: 100%; height: auto; max-height: 88mm; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
.numbers table { width: 100%; font-size: 7.4pt; line-height: 1.3; }
th, td { text-align: right; padding: .12mm .9mm; vertical-align: top; white-space: nowrap; }
thead th { border-bottom: .2mm solid #999; font-weight: 600; }
tbody th { font-weight: 600; }
td:first-child, th:first-child, td.words, th.words { text-align: left; }
tr.new > * { border-top: .1mm solid #ccc; }
tr.differs > * { background: #fbe3d6; font-weight: 700; }
tr.doubtful > * { background: #e8f0f7; }
tr.unknown > * { color: #555; font-style: italic; }
.summary table, .inputs table, .key table { width: 100%; font-size: 8.5pt; }
.summary th:first-child { overflow-wrap: anywhere; width: 30%; min-width: 24mm; }
@media print, (min-width: 641px) { .summary td:nth-child(2) { white-space: nowrap; } }
.summary td, .summary th { white-space: normal; text-align: left;
  padding: .5mm 1mm; border-bottom: .1mm solid #ccc; }
.inputs table { font-size: 8pt; line-height: 1.25; }
.inputs th { text-align: left; } .inputs td { text-align: left; padding-right: 3mm; }
.key td, .key th { white-space: normal; text-align: left; font-size: 7.2pt; line-height: 1.2; }
pre { font: 7.6pt/1.3 "DejaVu Sans Mono", "Liberation Mono", Menlo, Consolas, monospace;
  border: .2mm solid #bbb; padding: 2mm; margin: 0; white-space: pre-wrap;
  overflow-wrap: anywhere; }
mark { background: #d6e6f5; color: inherit; border-bottom: .35mm dashed #1f5f8b; padding: 0 .2mm; }
mark.differs { background: #fbd9c6; border-bottom: .45mm solid #a33c00; font-weight: 700; }
mark.over { background: none; border: .2mm dotted #777; }
ol, ul { margin: 0; padding-left: 5mm; } li { margin-bottom: .4mm; font-size: 8.5pt; }
.sign { display: grid; grid-template-columns: 1fr 1fr; gap: 9mm 8mm; margin: 8mm 0 4mm; }
.sign div { border-top: .3mm solid #333; padding-top: .6mm; font-size: 8pt; color: #333; }
.sign span { display: block; margin-top: -6mm; height: 5.4mm; font-size: 9.5pt; color: #1a1a1a; }
.provenance { font-size: 7.5pt; color: #333; }
.provenance td, .provenance th { white-space: normal; overflow-wrap: anywhere; text-align: left; }
.provenance th { width: 34%; padding-right: 4mm; font-weight: 400; }
tr, li, pre, .verdict, .sign, .picture, .provenance { break-inside: avoid; }
.whole { white-space: nowrap; }
h2 { break-after: avoid; }
@media screen and (max-width: 640px) {
  body { margin: 4mm auto; }
  .two { display: block; }
  .two > .picture { max-width: 100%; }
}
@media print { body { margin: 0 auto; padding: 0; }
  .verdict, tr.differs > *, tr.doubtful > *, mark {
  -webkit-print-color-adjust: exact; print-color-adjust: exact; } }
</style>
</head>
<body>
$sections
</body>
</html>
""")


def write_report(
    path: str,
    examined: Sequence[Examined],
    date: str | None = None,
    case: str | None = None,
    examiner: str | None = None,
) -> None:
    """Write the page for ``examined`` to ``path``, whole or not at all. Raises UserError."""
    page = report(examined, date, case, examiner)
    with files.replacing(path) as file:
        file.write(page)


def report(
    examined: Sequence[Examined],
    date: str | None = None,
    case: str | None = None,
    examiner: str | None = None,
) -> str:
    """The page as HTML. ``date``, ``case``, ``examiner``: the user's own, shown as given."""
    sections = [_cover(examined, date, case, examiner)]
    for one in examined:
        sections += [_section(result, one.sha256, date) for result in one.results]
    count = sum(len(one.results) for one in examined)
    title = f"Verification of {count} printout{'' if count == 1 else 's'}"
    return _PAGE.substitute(title=title, sections="\n".join(sections))


# --- the first sheet -----------------------------------------------------------------------------


def _cover(
    examined: Sequence[Examined], date: str | None, case: str | None, examiner: str | None
) -> str:
    parts = [
        "<section>",
        "<h1>Verification of printouts</h1>",
        '<p class="source">against R. M. Brach\'s 1988 program for the planar impact of two '
        "vehicles, replayed digit for digit</p>",
        "<h2>All files</h2>",
        _summary(examined),
        _signature(date, case, examiner),
        "<h2>What the verdicts mean</h2>",
        "<ul>",
        *(
            f"<li><b>{wording.title(verdict)}</b>: {escape(words)}</li>"
            for verdict, words in _LAY.items()
        ),
        "</ul>",
        _key(),
        _provenance(examined, date),
        "</section>",
    ]
    return "\n".join(parts)


def _summary(examined: Sequence[Examined]) -> str:
    rows = [
        '<div class="summary wide"><table><thead><tr><th scope="col">file</th>'
        '<th scope="col">printout</th><th scope="col">verdict</th><th scope="col">numbers</th>'
        "</tr></thead><tbody>"
    ]
    for one in examined:
        where = escape(files.called(one.file))
        if one.error:
            rows.append(
                f'<tr><th scope="row">{where}</th><td>–</td><td><b>NOT READ</b></td>'
                f"<td>{escape(one.error)}</td></tr>"
            )
        for result in one.results:
            rows.append(
                f'<tr><th scope="row">{where}</th><td>{result.number} (line {result.line})</td>'
                f"<td><b>{wording.title(result.verdict)}</b></td>"
                f"<td>{escape(wording.counts(result.fields))}</td></tr>"
            )
    return "\n".join([*rows, "</tbody></table></div>"])


def _signature(date: str | None, case: str | None, examiner: str | None) -> str:
    cells = (("case", case), ("examiner", examiner), ("date", date), ("signature", None))
    lines = "".join(
        f"<div><span>{escape(text or '')}</span>{name}{' (as given)' if text else ''}</div>"
        for name, text in cells
    )
    return f'<div class="sign">{lines}</div>'


def _key() -> str:
    """What the printed names mean."""
    rows = []
    for name in FIELDS:
        what = quantity("MU" if name == "MUP" else name)
        rows.append(
            f'<tr><th scope="row">{name}</th><td>{escape(what.meaning)}</td>'
            f"<td>{escape(what.unit)}</td></tr>"
        )
    half = (len(rows) + 1) // 2
    tables = "".join(
        '<table><thead><tr><th scope="col">name</th><th scope="col">meaning</th>'
        f'<th scope="col">unit</th></tr></thead><tbody>{"".join(part)}</tbody></table>'
        for part in (rows[:half], rows[half:])
    )
    return f'<h2>Key to the numbers</h2><div class="key two">{tables}</div>'


def _provenance(examined: Sequence[Examined], date: str | None) -> str:
    versions = provenance.versions()
    rows = [("program", f"impact88 {versions['impact88']}, {versions['python']}")]
    rows.append(("numpy, machine", f"{versions['numpy']}, {versions['machine']}"))
    for one in examined:
        rows.append((f"{files.called(one.file)}, SHA-256", one.sha256 or "not read"))
    rows += [
        ("listing, SHA-256", provenance.listing_hash()),
        ("captures, SHA-256", provenance.captures_hash()),
        ("date", f"{date} (as given)" if date else "not given"),
    ]
    cells = "".join(
        f'<tr><th scope="row">{escape(name)}</th><td>{escape(text)}</td></tr>'
        for name, text in rows
    )
    method = (
        "Recomputed: the 1988 listing, replayed bit for bit in Applesoft's 40-bit arithmetic, "
        "checked against captures of a real Apple II Plus ROM. Exact: Equations 13 to 18 in double "
        "precision; it does not bear on the verdict."
    )
    return f'<div class="provenance"><h2>Provenance</h2><table>{cells}</table><p>{method}</p></div>'


# --- one printout --------------------------------------------------------------------------------


def _section(result: Verification, sha256: str | None, date: str | None) -> str:
    where = escape(files.called(result.file))
    verdict = result.verdict
    summary = " ".join(f"{_sentence(line)}" for line in verification.summary(result))
    when = f', <span class="whole">{escape(date)}</span>' if date else ""
    parts = [
        "<section>",
        f"<h1>{where}, printout {result.number}</h1>",
        f'<p class="source">begins on line {result.line}'
        f"{', SHA-256 of the file ' + sha256 if sha256 else ''}"
        f"{when}</p>",
        f'<div class="verdict {verdict}"><b>{wording.title(verdict)}</b>'
        f"<p>{escape(_LAY[verdict])}</p><p>{escape(summary)}</p></div>",
        '<div class="two"><div class="numbers wide">',
        _numbers(result.fields),
        "</div>",
        f'<div class="picture">{_drawing(result)}{_inputs(result)}</div></div>',
        _explanations(result),
        _list("The page cannot show", result.unseen),
        _list("What the page shows besides", result.findings),
        _list("Beside the verdict", result.warnings),
        _as_read(result),
        _list("Doubtful places", list(_places(result))),
        _list("Notes on the reading", _notes(result)),
        "</section>",
    ]
    return "\n".join(part for part in parts if part)


def _sentence(text: str) -> str:
    return text[:1].upper() + text[1:] + ("" if text.endswith(".") else ".")


def _list(title: str, lines: Sequence[str]) -> str:
    if not lines:
        return ""
    items = "".join(f"<li>{escape(line)}</li>" for line in lines)
    return f"<h2>{title}</h2><ul>{items}</ul>"


def _numbers(checks: Sequence[FieldCheck]) -> str:
    rows = [
        '<table><thead><tr><th scope="col">number</th><th scope="col">printed</th>'
        '<th scope="col">recomputed</th><th scope="col" class="words">state</th>'
        '<th scope="col">exact</th><th scope="col">printed − exact</th></tr></thead><tbody>'
    ]
    line = 0
    for check in checks:
        kind, sign, word = _MARKS[Status(check.status)]
        kinds = [kind] if kind else []
        if FIELDS[check.name].line != line:
            line = FIELDS[check.name].line
            kinds.append("new")
        cells = [
            f'<th scope="row">{check.name}</th>',
            f"<td>{escape(check.printed or '–')}</td>",
            f"<td>{escape(check.recomputed or '–')}</td>",
            f'<td class="words">{sign} {word}</td>',
            f"<td>{escape(check.exact or '')}</td>",
            f"<td>{escape((check.difference or '').replace('-', '−'))}</td>",
        ]
        rows.append(f'<tr class="{" ".join(kinds)}">{"".join(cells)}</tr>')
    return "\n".join([*rows, "</tbody></table>"])


def _drawing(result: Verification) -> str:
    """The scene from above; none of a scene that was guessed at."""
    if not result.runnable or result.guessed or result.verdict is Verdict.INCOMPLETE:
        return ""
    from ..figures.sceneview import scene_svg

    scene = {name: text for name, text in result.scene.items() if text is not None}
    try:
        outcome = beside.solved(scene, [*FINAL_VELOCITIES, "STATUS"])
        return scene_svg(scene, outcome)
    except (UserError, ValueError):
        return "<p>(The scene cannot be drawn.)</p>"


def _inputs(result: Verification) -> str:
    """The recovered inputs, two a row; those not read exactly marked."""
    cells = []
    for name, text in result.scene.items():
        shown = escape(text) if text is not None else "<b>missing</b>"
        if name in result.guessed:
            shown += " <b>†</b>"
        cells.append(f'<th scope="row">{name}</th><td>{shown}</td>')
    rows = "".join(f"<tr>{''.join(cells[at : at + 3])}</tr>" for at in range(0, len(cells), 3))
    note = (
        "<p>† not read exactly on the paper: the value that explains the page best</p>"
        if result.guessed
        else ""
    )
    return f'<div class="inputs"><h2>Inputs recovered</h2><table>{rows}</table>{note}</div>'


def _explanations(result: Verification) -> str:
    if result.verdict is not Verdict.DIFFERS:
        return ""
    if not result.explanations:
        return f"<h2>Explanations, tested by replay</h2><p>{NO_SINGLE_SLIP}</p>"
    items: list[str] = []
    for one in result.explanations:
        text = escape(wording.cause(one))
        if one.look:
            text += "<br>look at " + "; ".join(map(escape, one.look[:4]))
        if one.rank > len(items):
            items.append(f"{text}<br>explains {one.explains} of {result.disagreements}")
        else:
            items[-1] += f"<br><i>or, {wording.NOT_TOLD_APART}:</i> {text}"
    items = [f"<li>{text}</li>" for text in items]
    return f"<h2>Explanations, tested by replay</h2><ol>{''.join(items)}</ol>"


def _as_read(result: Verification) -> str:
    """The text as it was read, every doubtful place marked."""
    if not result.text:
        return ""
    marks = sorted(_marks(result), key=lambda mark: mark[0])
    parts, place = [], result.start
    for start, stop, kind in marks:
        if start < place or start >= result.stop:
            continue
        parts.append(_visible(result.text[place:start]))
        parts.append(f'<mark class="{kind}">{_visible(result.text[start:stop]) or "_"}</mark>')
        place = max(stop, start)
    parts.append(_visible(result.text[place : result.stop]))
    legend = (
        "<p>dashed: doubtful; solid and bold: differs; dotted: belongs to no number</p>"
        if marks
        else ""
    )
    return f"<h2>The text as read</h2><pre>{''.join(parts)}</pre>{legend}"


def _visible(text: str) -> str:
    return escape("".join(c for c in text if c >= " " or c in "\n\t"))


def _marks(result: Verification) -> Iterator[tuple[int, int, str]]:
    for check in [*result.fields, *result.replies]:
        if check.start is None or check.stop is None:
            continue
        if check.status == Status.CONTRADICTED:
            yield check.start, check.stop, "differs"
        elif check.status in (Status.DOUBTFUL, Status.NOT_READ, Status.NOT_COMPARED):
            for one in check.doubts or [Doubtful(0, 0, check.start, "", "", "")]:
                yield one.start, one.start + max(1, len(one.read)), "doubtful"
    for label in result.labels:
        wrong = label.state is LabelState.CONTRADICTORY
        if wrong or label.doubt:
            yield label.start, label.stop, "differs" if wrong else "doubtful"
    for piece in result.left_over:
        if piece.beside:
            yield piece.start, piece.stop, "over"


def _places(result: Verification) -> Iterator[str]:
    yield from wording.labels(result.labels)
    for check in result.doubtful:
        yield from wording.doubts(check)


def _notes(result: Verification) -> list[str]:
    notes = [
        f"the reply {check.printed} for {check.name} is not the {check.recomputed} used"
        for check in result.replies
        if check.same is False
    ]
    return [*notes, *result.remarks, *wording.left_over(result.left_over)]
