"""Counts verdicts on pictures of pages whose truth is known, over every page offered.

    python tests/support/scanrates.py run PAGES RESULTS.jsonl [PART PARTS]
    python tests/support/scanrates.py table RESULTS.jsonl ...

PAGES is a folder of pictures with ``truth.jsonl.gz``, an object a picture: ``file``, ``kind``,
``prints`` and, of an altered page, ``altered`` or ``how``. Pages come in an order that is shuffled
once and for all, so that a run cut short is a sample; each is a line of RESULTS.jsonl, and pages
already there are passed over. ``table`` prints how many pages have each verdict.
"""

import gzip
import json
import random
import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from time import process_time
from typing import Any


def offered(folder: Path, part: int, parts: int) -> Iterator[dict[str, Any]]:
    """The truths of a folder's pages, shuffled once and for all; one of several parts of them."""
    with gzip.open(folder / "truth.jsonl.gz", "rt", encoding="utf-8") as file:
        pages = [json.loads(line) for line in file]
    random.Random(1988).shuffle(pages)
    return iter(pages[part::parts])


def run(folder: Path, results: Path, part: int = 0, parts: int = 1) -> None:
    """Verify each page that is not among the results yet, and add it to them."""
    from impact88.printouts.reporting.examination import examine

    lines = results.read_text(encoding="utf-8").splitlines() if results.exists() else []
    done = {json.loads(line)["file"] for line in lines}
    for truth in offered(folder, part, parts):
        if truth["file"] in done:
            continue
        begun = process_time()
        file = examine(str(folder / truth["file"]))
        row = {
            "file": truth["file"],
            "kind": truth["kind"],
            "condition": truth.get("condition"),
            "altered": truth.get("altered") or truth.get("how"),
            "printouts": len(truth["prints"]),
            "verdicts": [result.verdict.name for result in file.results],
            "findings": [text for result in file.results for text in result.findings],
            "remarks": [text for result in file.results for text in result.remarks],
            "error": file.error,
            "seconds": round(process_time() - begun, 2),
        }
        with results.open("a", encoding="utf-8") as out:
            out.write(json.dumps(row) + "\n")


KINDS = {
    "added": (
        *("minusadded", "appended", "prepended"),
        *("extraline", "extrainside", "lineduplicated", "rightofline"),
    ),
    "erased": ("minuserased", "pointerased", "erased"),
    "moved": ("pointmoved", "linesswapped", "numbersswapped", "labelsswapped", "labels"),
    "replaced": (
        *("digit", "digitresult", "exponent", "spinsadded", "twodigits"),
        *("pasted", "font", "line"),
    ),
}
"""Ways of altering a page, by kind of alteration."""
_ORDER = ("DIFFERS", "INCOMPLETE", "IDENTICAL_AS_READ", "IDENTICAL")
"""Verdicts: of several printouts on a page the first of these counts."""


def alteration_of(row: dict[str, Any]) -> str:
    """The kind of alteration of a page, ``none`` for a genuine one."""
    altered = row["altered"]
    if not altered:
        return "none"
    way = altered if isinstance(altered, str) else altered[0]
    # a digit in another's place is given by the number before and after alone
    named = row["kind"] in ("forged", "altered")
    return next(kind for kind, ways in KINDS.items() if way in ways) if named else "replaced"


def quality_of(row: dict[str, Any]) -> str:
    """The quality of a page, or how it came onto paper."""
    if not row["condition"]:
        return "not graded"
    return ("photograph, " if row["kind"] == "photo" else "scan, ") + row["condition"]


def verdict_of(row: dict[str, Any]) -> str:
    """The verdict on a page: printouts that were not found were left open."""
    verdicts = list(row["verdicts"])
    if len(verdicts) < row["printouts"]:
        verdicts.append("INCOMPLETE")
    return min(verdicts, key=_ORDER.index)


def table(paths: Sequence[str]) -> Iterator[str]:
    """Yield a heading, and a line for each kind of alteration and quality of picture."""
    counts: Counter[tuple[str, str, str]] = Counter()
    for path in paths:
        for line in Path(path).read_text(encoding="utf-8").splitlines():
            row = json.loads(line)
            counts[alteration_of(row), quality_of(row), verdict_of(row)] += 1
    kinds = ["none", "replaced", "added", "erased", "moved"]
    pairs = {key[:2] for key in counts}
    yield ",".join(("alteration", "quality", *reversed(_ORDER)))
    for kind, quality in sorted(pairs, key=lambda pair: (kinds.index(pair[0]), pair[1])):
        numbers = [str(counts[kind, quality, verdict]) for verdict in reversed(_ORDER)]
        yield ",".join((kind, f'"{quality}"', *numbers))


if __name__ == "__main__":
    if sys.argv[1] == "table":
        print("\n".join(table(sys.argv[2:])))
    if sys.argv[1] == "run":
        run(Path(sys.argv[2]), Path(sys.argv[3]), *map(int, sys.argv[4:6]))
