"""Scene files: flat TOML, keyed by the listing's names, read and written.

Values keep their raw text; TOML's parsed number is never used.
"""

from __future__ import annotations

import os
import re
from collections import namedtuple
from collections.abc import Collection, Mapping, Sequence

from ..errors import UserError, quoted
from ..files import display_name, read_text
from ..names import DEFAULT_M, SCENE, quantity
from .case import ABOUT, OWN_AXES, SOURCE, Case
from .doubles import is_number

TYPE_CHECKING = False
if TYPE_CHECKING:
    from .units import System

MAX_TOML_BYTES = 100_000  # bounds the time to read; a complete scene has 2,000
MAX_ENTRY_LENGTH = 2_000  # characters a line; TOML parsers may be slow with long keys
_ENTRY = r"""[ \t]*(?:([A-Za-z0-9_-]+)|"([^"]*)"|'([^']*)')[ \t]*=[ \t]*(.*)"""


def case_in(
    path: str, units: str | None = None, axes: str | None = None, headings: str | None = None
) -> Case:
    """Return the case in a TOML file (``-``: standard input). Raises UserError."""
    if not isinstance(path, str | os.PathLike):
        raise UserError(f"{quoted(path)} is not the name of a file")
    path = os.fspath(path)
    return Case(toml_file(path), display_name(path), units, axes, headings)


def toml_file(path: str) -> dict[str, str]:
    """Return the entries of a flat TOML file (``-``: standard input), see `toml_texts`."""
    return toml_texts(read_text(path, MAX_TOML_BYTES), display_name(path))


def toml_texts(text: str, source: str) -> dict[str, str]:
    """Return the entries of a flat TOML document, one per line, as texts by name.

    A number keeps its digits; a string gives its contents. ``NAME = {value = ..., source = ...}``,
    or a table with these keys, gives NAME and NAME_source. Raises UserError for anything else,
    naming the line."""
    texts: dict[str, str] = {}
    lines: dict[str, int] = {}
    tables: dict[str, str] = {}
    table = ""
    for number, line in enumerate(text.split("\n"), 1):
        place = f"{source}, line {number}"
        if len(line) > MAX_ENTRY_LENGTH:
            message = f"has more than {MAX_ENTRY_LENGTH:,} characters; expected one value a line"
            raise UserError(message, place)
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        if header := re.fullmatch(r"\s*\[([A-Za-z0-9_-]+)\]\s*(#.*)?", line):
            table = header[1]
            if table in lines or table in tables:
                raise UserError(f"{table} is given twice", place)
            tables[table] = place
            continue
        if (match := re.match(_ENTRY, line)) is None:
            if re.match(r"\s*\d+ *[A-Za-z?]", line):
                raise UserError(
                    "is a BASIC program, not a scene; impact88 basic runs it, and run and verify "
                    "take another copy of the listing as --listing",
                    source,
                )
            raise UserError(f"{quoted(line.strip())} is not an entry; expected NAME = VALUE", place)
        key = match[1] or match[2] or match[3] or ""
        if table:
            if key not in ("value", "source"):
                raise UserError(f"{table} is a table; expected a number", place)
            key = table if key == "value" else table + SOURCE
        if key in lines:
            raise UserError(f"{key} is given twice (first in line {lines[key]})", place)
        lines[key] = number
        texts |= _toml_values(key, match[4], place)
    for table, place in tables.items():
        if table not in texts:
            raise UserError(f"{table} is a table; expected a number", place)
    return texts


def _toml_values(key: str, text: str, where: str) -> dict[str, str]:
    """Return the entries of one line ``key = text``: the value, and its source if it has one."""
    import tomllib

    raw = text.partition("#")[0].strip()
    try:
        value = tomllib.loads(f"x = {text}")["x"]
    except RecursionError:
        raise UserError("nested too deeply; expected one value a line", where) from None
    except tomllib.TOMLDecodeError as error:
        if not raw:
            raise UserError(f"{key} has no value; expected a number", where) from None
        if raw[:3] in ('"""', "'''"):
            raise UserError(
                "has a text of several lines; expected one value a line", where
            ) from None
        if not is_number(raw):
            reason = str(error).partition(" (at line")[0]
            raise UserError(f"{key} = {quoted(raw)} is not TOML: {reason}", where) from None
        with_digits = re.sub(r"\.(?![0-9])", ".0", re.sub(r"^([+-]?)\.", r"\g<1>0.", raw))
        bare = f"{with_digits} or " if _plain_toml(with_digits) else ""
        raise UserError(f'{key} = {raw} is not TOML; write {bare}"{raw}"', where) from None
    texts = {}
    if isinstance(value, dict) and "value" in value and set(value) <= {"value", "source"}:
        if "source" in value:
            texts[key + SOURCE] = str(value["source"])
        value = value["value"]
        raw = re.sub(r".*?\bvalue\s*=\s*([^,}]*).*", r"\1", raw).strip()
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        kind = {bool: "a truth value", list: "a list", dict: "a table"}.get(type(value), "a date")
        raise UserError(f"{key} is {kind}; expected a number", where)
    if not isinstance(value, str) and not is_number(raw):
        raise UserError(f"{key} = {raw} is not a number that INPUT takes", where)
    return {key: value if isinstance(value, str) else raw, **texts}


SIGNS = """\
   y ^                 ^ t          GA = 0: the contact plane, C its point, along y; n along x
     |                 |            n = (cos GA, sin GA), t = (-sin GA, cos GA)
     +---> x    [ B >] C [< A ]     A lies on the +n side of the plane, B on the other
                       |            TA = TB = 0: B faces TB, A faces TA + 180
                       +---> n      PA, PB: from the vehicle's front to C, seen from its center

Angles and spins are positive counterclockwise. An approach has A moving against n, towards B.
The impulse P_n n + P_t t acts on A, its opposite on B; friction (MU above 0) opposes the sliding.
"""
"""Sides, axes and signs, explained at the top of a scene file."""


def template(case: Case | None = None, units: str | None = None) -> str:
    """Return a commented scene file: that of ``case`` with its texts as written, or one to fill in,
    whose bare numbers are in the system ``units``."""
    from .units import system_of

    system = case.system if case else system_of(units)
    texts = case.texts if case else {"M": DEFAULT_M, "units": units or ""}
    lines = [
        "# A scene for impact88. Any consistent units; angles in degrees, spins in radians per",
        '# unit of time. The digits are used as written. Write 0.911 or ".911": TOML takes no .911',
        "#",
        *(f"# {line}".rstrip() for line in SIGNS.splitlines()),
        "",
        f"title = {_toml_string(texts.get('title', ''))}",
        *_about_lines(case.about if case else texts),
    ]
    heading, remaining = None, _remaining(texts, SCENE)
    for row in SCENE.values():
        if row.line != heading:
            heading = row.line
            lines += ["", f"# line {heading} of the listing"]
        if row.name not in texts and (contact_names := _in_place_of(row.name, texts)):
            lines += [line for name in contact_names for line in _entry(name, texts, 20, system)]
            remaining = [name for name in remaining if name not in contact_names]
        elif not _in_place_of(row.name, texts, either=True) or row.name in texts:
            line, *source = _entry(row.name, texts, 20, system)
            mark = ", estimated" if case and row.name in case.estimated else ""
            lines += [line + mark, *source]
    if remaining:
        lines += ["", *(line for name in remaining for line in _entry(name, texts, 20, system))]
    return "\n".join(lines) + "\n"


class CaseTemplate(namedtuple("CaseTemplate", "title command remarks entries")):
    """A kind of collision: what it is, the command that takes its file, remarks for who fills it
    in, and its entries, each with the text it begins with ("" to fill in)."""

    __slots__ = ()


_FACING = {"TA": "course", "TB": "course"}
CASES = {
    "intersection": CaseTemplate(
        "Intersection: speeds before from skids and departure angles",
        "reconstruct",
        (
            "Momentum alone: masses, the ways the vehicles came and left, and their speeds after.",
            'A skid to rest is a speed: SAF = "skid 62 ft at 0.7 +- .05". Courses are',
            "counterclockwise from x. Leave SAF and SBF empty and give SA and SB for the converse.",
        ),
        {
            "M": "4",
            **dict.fromkeys(("MA", "MB", "HA", "HB", "SAF", "HAF", "SBF", "HBF"), ""),
            **_FACING,
        },
    ),
    "rear-end": CaseTemplate(
        "Rear end: delta-V from closing speed and restitution",
        "reconstruct",
        ("Both along x, A into B. B's speed is 0 where it stands; E is .1 to .4 at low speeds.",),
        {
            "M": "4",
            "MA": "",
            "MB": "",
            "SA": "",
            "HA": "0",
            "SB": "0",
            "HB": "0",
            "E": "",
            **_FACING,
        },
    ),
    "head-on": CaseTemplate(
        "Head-on: speeds after and delta-V",
        "reconstruct",
        ("Along one line: A along x, B against it. E = 0 leaves them locked together.",),
        {
            "M": "4",
            "MA": "",
            "MB": "",
            "SA": "",
            "HA": "0",
            "SB": "",
            "HB": "180",
            "E": "0",
            **_FACING,
        },
    ),
    "barrier": CaseTemplate(
        "Barrier: one vehicle against a rigid barrier",
        "chapter barrier",
        ("The barrier is along y where GA = 0; A drives against n, and faces it where TA = 0.",),
        {
            **dict.fromkeys(("MA", "IA", "DA", "PA"), ""),
            "TA": "0",
            "GA": "0",
            "E": "",
            "MU": "",
            "EM": "1",
            "UX": "",
            "UY": "0",
            "WA": "0",
        },
    ),
    "planar": CaseTemplate(
        "Planar impact: velocities after from those before",
        "solve",
        (*SIGNS.rstrip().splitlines(), "", 'MU = "locked" ends the sliding; EM = 1 is no moment.'),
        {**dict.fromkeys(SCENE, ""), "WA": "0", "WB": "0", "EM": "1", "M": "6"},
    ),
    "crush": CaseTemplate(
        "Crush energy to delta-V (Equation 19)",
        "chapter delta-v",
        ("An estimate from the energy lost, fitted to eleven staged collisions.",),
        dict.fromkeys(("MA", "MB", "SA", "SB", "EL"), ""),
    ),
}
"""The kinds of collision that `case_template` offers, by the field's names."""


def case_template(name: str, units: str | None = None) -> str:
    """Return a file to fill in that holds what a kind of collision (`CASES`) needs, and nothing
    else; its bare numbers are in the system ``units``, ft, lb and mph by default."""
    from .units import system_of

    units = units or "us"
    case, system = CASES[name], system_of(units)
    lines = [f"# {case.title}", "#", *(f"# {line}".rstrip() for line in case.remarks)]
    lines += [f"# Filled in, it goes to: impact88 {case.command} FILE", "", f'units = "{units}"']
    for entry in case.entries:
        lines += _entry(entry, case.entries, 16, system)
    return "\n".join(lines) + "\n"


def _in_place_of(name: str, texts: Mapping[str, str], either: bool = False) -> tuple[str, ...]:
    """Return CAF CAL (CBF CBL) if they are given in place of DA (DB), else nothing; with ``either``
    also for PA (PB)."""
    contact_names = OWN_AXES.get(name[1:], ()) if name[0] in "DP" else ()
    present = set(contact_names) & set(texts) and (either or name[0] == "D")
    return tuple(contact_names) if present else ()


def known_template(names: Sequence[str], case: Case | None = None) -> str:
    """Return a file with entries for ``names`` to fill in, filled with the values of ``case``."""
    from .units import RULES

    system = case.system if case else RULES
    texts = case.texts if case else {"M": DEFAULT_M}
    lines = ["# Fill in what is known; what stays empty is solved for. Any consistent units."]
    if texts.get("title"):
        lines.append(f"title = {_toml_string(texts['title'])}")
    lines += _about_lines(case.about if case else texts)
    for name in names:
        lines += _entry(name, texts, 12, system, quotes=True)
    for name in _remaining(texts, names) if case else ():
        lines += _entry(name, texts, 12, system, quotes=True)
    return "\n".join(lines)


def _about_lines(texts: Mapping[str, str]) -> list[str]:
    """Return the lines about the whole file, except the title."""
    return [
        f"{name} = {_toml_string(texts[name])}"
        for name in ABOUT
        if name != "title" and texts.get(name)
    ]


def _remaining(texts: Mapping[str, str], names: Collection[str]) -> list[str]:
    """Return entries other than ``names``, sources and entries about the whole file."""
    return [n for n in texts if n not in names and n not in ABOUT and not n.endswith(SOURCE)]


def _entry(
    name: str, texts: Mapping[str, str], width: int, system: System, quotes: bool = False
) -> list[str]:
    """Return the line of an entry with its meaning, and the line of its source."""
    text = texts.get(name, DEFAULT_M if name == "M" else "")
    entry = f"{name} = {text if _plain_toml(text) and not quotes else _toml_string(text)}"
    try:
        row = quantity(name)
    except KeyError:
        lines = [entry]
    else:
        meaning = "signed P_t/P_n, in place of MU" if quotes and name == "MUP" else row.meaning
        symbol = f"{row.symbol}: " if row.symbol else ""
        lines = [f"{entry:<{width}} # {symbol}{meaning} [{system.label(row.unit)}]"]
    if name + SOURCE in texts:
        lines.append(f"{name}{SOURCE} = {_toml_string(texts[name + SOURCE])}")
    return lines


def _toml_string(text: str) -> str:
    """Return a text as a one-line TOML string."""
    line = "".join(character if character.isprintable() else " " for character in text)
    return '"{}"'.format(line.replace("\\", "\\\\").replace('"', '\\"'))


def _plain_toml(text: str) -> bool:
    """Return True if TOML accepts the number unquoted."""
    return re.fullmatch(r"[+-]?(0|[1-9][0-9]*)(\.[0-9]+)?([eE][+-]?[0-9]+)?", text) is not None
