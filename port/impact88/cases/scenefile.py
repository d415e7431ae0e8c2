"""Scene files: flat TOML, keyed by the listing's names, read and written.

The digits of a value stay as they are in the file; TOML's binary numbers are never used."""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Mapping
from typing import NamedTuple

from ..errors import UserError, printable, quoted
from ..names import CHAPTER, RESULTS, SCENE
from .units import View

ABOUT = ("title", "case", "examiner", "date", "units", "axes", "headings", "correlations")
"""Entries about the whole file."""
INPUTS = {**SCENE, **RESULTS, **CHAPTER}
"""Quantities that a file may give."""
SOURCE = "_source"
"""Suffix of an entry that says where a value comes from: UX_source = "event data recorder"."""
MAX_CHARACTERS = 20_000  # tomllib takes a second for a key of that length; a scene has 2,000
_KEY = re.compile(r"""[ \t]*\[?[ \t]*["']?([A-Za-z0-9_-]+)["']?[ \t]*[=\]]""")

SIGNS = """\
   y ^                 ^ t          GA = 0: the contact plane, C its point, along y; n along x
     |                 |            n = (cos GA, sin GA), t = (-sin GA, cos GA)
     +---> x    [ B >] C [< A ]     A lies on the +n side of the plane, B on the other
                       |            TA = TB = 0: B faces TB, A faces TA + 180
                       +---> n      PA, PB: from the vehicle's front to C, seen from its center

Angles and spins are positive counterclockwise. An approach has A moving against n, towards B.
The impulse P_n n + P_t t acts on A, its opposite on B; friction (MU above 0) opposes the sliding.
"""
"""Sides, axes and signs."""


def read_toml(text: str, source: str) -> tuple[dict[str, str], dict[str, str]]:
    """Return the entries of a flat TOML document as texts, and their places: file and line.

    Raises
    ------
    UserError
        For text that is not TOML and for values that are neither numbers nor texts.
    """
    if len(text) > MAX_CHARACTERS:
        raise UserError(
            f"is longer than {MAX_CHARACTERS:,} characters; expected NAME = VALUE a line", source
        )
    places = {
        match[1]: f"{source}, line {number}"
        for number, line in enumerate(text.split("\n"), 1)
        if (match := _KEY.match(line))
    }
    try:
        values = tomllib.loads(text, parse_float=str)
    except (RecursionError, ValueError) as error:  # also a whole number of 4,300 digits
        raise UserError(
            f"is not TOML: {error}; expected NAME = VALUE, a number with a digit first (0.9) or a "
            "text in quotes",
            source,
        ) from None
    for name, value in values.items():
        if isinstance(value, bool | list | dict):
            raise UserError(
                f"{name} = {quoted(value)}: expected a number or a text", places.get(name, source)
            )
    return {name: str(value) for name, value in values.items()}, places


def write_toml(texts: Mapping[str, str], view: View) -> str:
    """Return a commented scene file.

    Parameters
    ----------
    texts : mapping of str to str
        Entries as written.
    view : View
        Its units are those of the comments.

    Returns
    -------
    str
        The file; `read_toml` gives the texts back.
    """
    order = [*ABOUT, *INPUTS]
    lines = []
    for name in sorted(texts, key=lambda n: (order.index(n.removesuffix(SOURCE)), n)):
        text, row = texts[name], INPUTS.get(name)
        if not _PLAIN_TOML.fullmatch(text):
            text = json.dumps(printable(text), ensure_ascii=False)
        line = f"{name} = {text}"
        comment = f"# {view.meaning(name)} [{view.unit(name) or row.unit}]" if row else ""
        lines.append(f"{line:<20} {comment}".rstrip())
    return "\n".join(lines) + "\n"


_PLAIN_TOML = re.compile(r"[+-]?(0|[1-9][0-9]*)(\.[0-9]+)?([eE][+-]?[0-9]+)?")
"""Numbers that TOML takes without quotes."""


class Template(NamedTuple):
    """A kind of collision: its title, advice, and its entries, as NAME or NAME=TEXT."""

    title: str
    advice: str
    words: str

    @property
    def entries(self) -> dict[str, str]:
        """The text that each entry begins with, by name."""
        words = self.words.split()
        return {name: text for name, _, text in (word.partition("=") for word in words)}


TEMPLATES = {
    "intersection": Template(
        "Intersection: speeds before, from skids",
        "Momentum alone: masses, courses before and after, and speeds after. A skid to rest is a\n"
        'speed: SAF = "skid 62 ft at 0.7 +- .05". Courses are counterclockwise from x. Leave SAF\n'
        "and SBF empty and give SA and SB for the converse.",
        "M=4 MA MB HA HB SAF HAF SBF HBF TA=course TB=course",
    ),
    "rear-end": Template(
        "Rear end: delta-V from closing speed",
        "Both along x, A into B. SB is 0 for a standing car; E is .1 to .4 at low speeds.",
        "M=4 MA MB SA HA=0 SB=0 HB=0 E TA=course TB=course",
    ),
    "head-on": Template(
        "Head-on: speeds after and delta-V",
        "Along one line: A along x, B against it. E = 0 leaves them locked together.",
        "M=4 MA MB SA HA=0 SB HB=180 E=0 TA=course TB=course",
    ),
    "planar": Template(
        "Planar impact: velocities after",
        f'{SIGNS}\nMU = "locked" ends the sliding; EM = 1 is no moment.',
        "E MU EM=1 DA DB GA PA PB TA TB MA MB IA IB UX UY WA=0 VX VY WB=0 M=6",
    ),
    "barrier": Template(
        "Barrier: one vehicle on a rigid barrier",
        "The barrier is along y where GA = 0; A drives against n, and faces it where TA = 0.",
        "MA IA DA PA TA=0 GA=0 E MU EM=1 UX UY=0 WA=0 MB=inf IB=inf DB=0 PB=0 TB=0 VX=0 VY=0 WB=0",
    ),
    "crush": Template(
        "Crush: speed before, B at rest",
        "EBSA and EBSB are equivalent barrier speeds of the crush; the energies ELA and ELB, or\n"
        "their sum EL, may replace them. A drives along x into B, and both go on along it.",
        "M=4 MA MB EBSA EBSB HA=0 SB=0 E=.1 HAF=0 TA=course TB=course",
    ),
}
"""The kinds of collision that `template` offers."""


def template(kind: str = "planar", units: str = "us") -> str:
    """Return a scene file to fill in, with what a kind of collision needs and no more.

    Parameters
    ----------
    kind : str, default "planar"
        A name of `TEMPLATES`.
    units : {"us", "chapter", "metric", "si"}, default "us"
        System of the file's bare numbers.

    Returns
    -------
    str
        A TOML document.

    Raises
    ------
    UserError
        For another kind or system.

    Examples
    --------
    >>> print(template("crush", "metric").splitlines()[-5])
    MA = ""              # mass of A [kg]
    """
    if kind not in TEMPLATES:
        raise UserError(
            f"{quoted(kind)} is not a kind of collision; expected {', '.join(TEMPLATES)}"
        )
    title, advice, _ = TEMPLATES[kind]
    view = View.of(units=units)
    comment = f"\n{title}\n\n{advice}\nFilled in, it goes to: impact88 solve FILE".replace(
        "\n", "\n# "
    )
    return f"{comment[1:]}\n\n{write_toml({'units': view.units, **TEMPLATES[kind].entries}, view)}"
