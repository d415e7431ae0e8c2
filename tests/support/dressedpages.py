"""Fresh pages of the program in the dresses people send them in, and altered in one character.

    python tests/support/dressedpages.py [GENUINE [ALTERED [SEED]]]

prints one table of the verdicts on both: genuine pages by dress, altered ones by what was done.
With 1000 and 2000 it takes ten minutes of a processor.
"""

from __future__ import annotations

import random
import re
import sys
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import captures

import impact88
from impact88.printouts.reporting.verification import DOUBTFUL, NOTES, Verification, sections

Dress = Callable[[str], str | bytes]


# --- fresh pages ----------------------------------------------------------------------------------


def _fresh_number(text: str, rng: random.Random) -> str:
    """A number near another, with as many decimals; zeros stay."""
    value = float(text)
    if not value or "E" in text:
        return text
    decimals = len(text.partition(".")[2])
    fresh = f"{value * rng.uniform(0.6, 1.6):.{decimals}f}"
    fresh = re.sub(r"^(-?)0\.", r"\1.", fresh)
    return fresh if float(fresh) else text


def fresh_pages(count: int, seed: int = 1) -> Iterator[str]:
    """Pages of scenes that nobody has seen, each run to its normal end."""
    rng = random.Random(seed)
    rows = [row for row in captures.scenes() if "VAX=" in row["printout"]]
    while count:
        scene = dict(rng.choice(rows)["scene"])
        for name in scene:
            if name != "M":
                scene[name] = _fresh_number(scene[name], rng)
        ran = impact88.run(scene)
        if ran.error is None and not ran.zero_determinant and "VAX=" in ran.page:
            yield ran.page
            count -= 1


# --- dresses --------------------------------------------------------------------------------------


def _body(page: str) -> str:
    return page[page.index("MA=", page.rindex("?")) :]


def _wrapped(width: int) -> Dress:
    return lambda page: "\n".join(
        line[at : at + width]
        for line in page.split("\n")
        for at in range(0, max(1, len(line)), width)
    )


def _tight(page: str) -> str:
    return re.sub(r"\n+", "\n", re.sub(" +", " ", page))


def _loose(page: str) -> str:
    return page.replace(" ", "   ").replace("\n", "\n\n")


def _tabs(page: str) -> str:
    return re.sub(" {2,}", "\t", page.replace("= ", "=\t"))


def _dashes(page: str) -> str:
    return page.replace("-", "−")


def _quoted(page: str) -> str:
    return "\n".join("> " + line for line in page.split("\n"))


def _indented(page: str) -> str:
    return "\n".join("        " + line for line in page.split("\n"))


def _letter(page: str) -> str:
    return f"Dear colleague,\nthis is the page in question.\n\n{page}\n\nYours, A. Miller\n"


def _footed(page: str) -> str:
    return f"Brown & Partners, Engineers\n\n{page}\n\n- 7 -\n"


def _same(page: str) -> str:
    return page


_FORMS: dict[str, Callable[[str], str]] = {
    "as printed": _same,
    "wrapped at 40": _wrapped(40),
    "wrapped at 72": _wrapped(72),
    "tabs": _tabs,
    "capitals": str.upper,
    "small letters": str.lower,
    "tight": _tight,
    "loose": _loose,
    "dashes": _dashes,
    "quoted": _quoted,
    "indented": _indented,
    "in a letter": _letter,
    "header and footer": _footed,
}  # type: ignore[dict-item]
_FILES: dict[str, Dress] = {
    "CRLF": lambda page: page.replace("\n", "\r\n").encode(),
    "BOM": lambda page: b"\xef\xbb\xbf" + page.encode(),
    "UTF-16": lambda page: page.encode("utf-16"),
}


def _both(first: Dress, second: Dress) -> Dress:
    return lambda page: second(first(page))  # type: ignore[arg-type]


DRESSES: dict[str, Dress] = {
    **_FORMS,
    **_FILES,
    **{
        f"{first}, {second}": _both(_FORMS[first], (_FORMS | _FILES)[second])
        for first, second in (
            ("tight", "quoted"),
            ("loose", "small letters"),
            ("capitals", "indented"),
            ("tabs", "CRLF"),
            ("dashes", "UTF-16"),
            ("wrapped at 40", "CRLF"),
            ("small letters", "in a letter"),
            ("wrapped at 72", "BOM"),
        )
    },
    **{
        f"without prompts, {name}": _both(_body, dress)
        for name, dress in (_FORMS | _FILES).items()
        if name in ("as printed", "tight", "tabs", "quoted", "dashes", "in a letter")
    },
}
"""Thirty dresses of a page, by name."""


# --- alterations ----------------------------------------------------------------------------------

_TYPED = "0123456789.-+=()%*?,ABCDEFGHIKLMNOPRSTUVWXY"


def _places(page: str) -> list[int]:
    return [at for at, char in enumerate(page) if not char.isspace()]


def added(page: str, rng: random.Random) -> str:
    """One character more, beside another."""
    at = rng.choice(_places(page)) + rng.randint(0, 1)
    return page[:at] + rng.choice(_TYPED) + page[at:]


def removed(page: str, rng: random.Random) -> str:
    """One character fewer."""
    at = rng.choice(_places(page))
    return page[:at] + page[at + 1 :]


def replaced(page: str, rng: random.Random) -> str:
    """One character is another; a figure is mostly another figure."""
    at = rng.choice(_places(page))
    pool = "0123456789" if page[at].isdigit() and rng.random() < 0.8 else _TYPED
    return page[:at] + rng.choice([c for c in pool if c != page[at].upper()]) + page[at + 1 :]


def moved_within_a_row(page: str, rng: random.Random) -> str:
    """One character stands elsewhere on its row."""
    at = rng.choice(_places(page))
    start = page.rfind("\n", 0, at) + 1
    stop = (page.find("\n", at) + len(page) + 1) % (len(page) + 1)
    to = rng.randint(start, stop - 1)
    rest = page[:at] + page[at + 1 :]
    return rest[:to] + page[at] + rest[to:]


def moved_to_another_row(page: str, rng: random.Random) -> str:
    """One character stands on the row above or below, at the same place."""
    lines = page.split("\n")
    filled = [at for at, line in enumerate(lines) if line.strip()]
    number = rng.choice(filled)
    at = rng.choice([at for at, char in enumerate(lines[number]) if not char.isspace()])
    char = lines[number][at]
    lines[number] = lines[number][:at] + lines[number][at + 1 :]
    to = number + rng.choice((-1, 1)) if 0 < number < len(lines) - 1 else number - 1
    other = lines[to].ljust(at)
    lines[to] = other[:at] + char + other[at:]
    return "\n".join(lines)


def exchanged(page: str, rng: random.Random) -> str:
    """Two characters are in each other's place, mostly neighbours."""
    places = _places(page)
    first = rng.choice(places)
    near = rng.random() < 0.7
    others = [at for at in places if page[at] != page[first] and (abs(at - first) < 3) == near]
    if not others:
        return exchanged(page, rng)
    low, high = sorted((first, rng.choice(others)))
    return page[:low] + page[high] + page[low + 1 : high] + page[low] + page[high + 1 :]


ALTERATIONS: dict[str, Callable[[str, random.Random], str]] = {
    "added": added,
    "removed": removed,
    "replaced": replaced,
    "moved within a row": moved_within_a_row,
    "moved to another row": moved_to_another_row,
    "exchanged": exchanged,
}


class Altered(NamedTuple):
    """A page with one character altered, how, and the page as printed."""

    text: str
    how: str
    genuine: str


def altered_pages(count: int, seed: int = 2) -> Iterator[Altered]:
    """Fresh pages, each altered in one character; ones that read as before are left out."""
    rng = random.Random(seed)
    pages = fresh_pages(10 * count, seed)
    hows = list(ALTERATIONS)
    while count:
        how, page = hows[count % len(hows)], next(pages)
        text = ALTERATIONS[how](page, rng)
        if characters(text) != characters(page):
            yield Altered(text, how, page)
            count -= 1


def characters(page: str) -> str:
    """What stands on a page, without blanks, in capitals."""
    return "".join(page.split()).upper()


# --- scores ---------------------------------------------------------------------------------------

SETTLED = ("IDENTICAL", "IDENTICAL_AS_READ")


def results_of(data: str | bytes) -> Sequence[Verification]:
    """The verdicts on the printouts of a text, none if it is refused."""
    try:
        return impact88.verify(data if isinstance(data, bytes) else data.encode())
    except impact88.UserError:
        return []


def verdict_of(results: Sequence[Verification]) -> str:
    """The verdict on the only printout of a text; ``count printouts`` for several."""
    if len(results) != 1:
        return f"{len(results)} printouts" if results else "refused"
    return results[0].verdict.name


NOT_NAMED = "IDENTICAL_AS_READ, place not named"
FOUND = ("DIFFERS", "IDENTICAL_AS_READ", "printed so")
"""Scores of an altered page of which nothing is passed over."""


def score_of(page: Altered, results: Sequence[Verification]) -> str:
    """The verdict on an altered page; whether the altered place is named where it is no more than a
    doubt, and whether the program prints just that where it is none."""
    verdict = verdict_of(results)
    if verdict == "IDENTICAL" and is_printed_so(page.text):
        return "printed so"
    if verdict == "IDENTICAL_AS_READ" and not is_named(page, results[0]):
        return NOT_NAMED
    return verdict


def is_named(page: Altered, result: Verification) -> bool:
    """Whether a doubt or a note is on a line that was altered."""
    parts = sections(result)
    told = " ".join([*parts.get(DOUBTFUL, []), *parts.get(NOTES, [])])
    pairs = zip(page.genuine.split("\n"), page.text.split("\n"), strict=True)
    altered = {str(number) for number, (old, new) in enumerate(pairs, 1) if old != new}
    return not altered.isdisjoint(re.findall(r"\bline ([0-9]+)", told))


def is_printed_so(text: str) -> bool:
    """Whether the program prints exactly this text's characters for the scene recovered from it."""
    (result,) = impact88.verify(text.encode())
    scene = result.complete_scene
    return bool(scene) and characters(impact88.run(scene).page) == characters(text)


def main(genuine: int = 300, altered: int = 600, seed: int = 1) -> None:
    """Print the table."""
    rows: dict[str, Counter[str]] = {}
    names = list(DRESSES)
    for at, page in enumerate(fresh_pages(genuine, seed)):
        name = names[at % len(names)]
        rows.setdefault(f"genuine: {name}", Counter())[
            verdict_of(results_of(DRESSES[name](page)))
        ] += 1
    for page in altered_pages(altered, seed + 1):
        score = score_of(page, results_of(page.text))
        if score not in FOUND:
            print(f"{score}, {page.how}:", _difference(page), file=sys.stderr)
        rows.setdefault(f"altered: {page.how}", Counter())[score] += 1
    for kind in ("genuine", "altered"):
        total = Counter[str]()
        for name, counts in rows.items():
            if name.startswith(kind):
                total += counts
                print(f"{name:45}", *(f"{verdict} {n}" for verdict, n in sorted(counts.items())))
        passed = sum(total[score] for score in (SETTLED if kind == "genuine" else FOUND))
        print(f"{kind} in all: ", *(f"{verdict} {n}" for verdict, n in sorted(total.items())))
        print(f"{'settled' if kind == 'genuine' else 'found'}: {passed / total.total():.1%}\n")


def _difference(page: Altered) -> str:
    pairs = zip(page.genuine.split("\n"), page.text.split("\n"), strict=False)
    return " | ".join(f"{old!r} -> {new!r}" for old, new in pairs if old != new)


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
