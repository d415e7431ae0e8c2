"""Scene files: flat TOML, keyed by the listing's names, read and written.

Only the raw text of a value is used, never TOML's own idea of the number.
"""

from __future__ import annotations

import os
import re
from collections.abc import Collection, Mapping, Sequence

from ..errors import UserError, quoted
from ..files import called, read_text
from ..names import DEFAULT_M, SCENE, quantity
from .case import ABOUT, OWN_AXES, SOURCE, Case
from .doubles import is_number

TYPE_CHECKING = False
if TYPE_CHECKING:
    from .units import System

TOML_LIMIT = 100_000
"""Bytes of the largest scene file that is read: a bound on time; a whole scene has 2,000."""
LONGEST_ENTRY = 2_000
"""Characters of the longest line of a scene file; a TOML reader may be slow with long keys."""
_ENTRY = r"""[ \t]*(?:([A-Za-z0-9_-]+)|"([^"]*)"|'([^']*)')[ \t]*=[ \t]*(.*)"""


def case_in(
    path: str, units: str | None = None, axes: str | None = None, headings: str | None = None
) -> Case:
    """Return the case in a TOML file (``-``: standard input). Raises UserError."""
    if not isinstance(path, str | os.PathLike):
        raise UserError(f"{quoted(path)} is not the name of a file")
    path = os.fspath(path)
    return Case(toml_file(path), called(path), units, axes, headings)


def toml_file(path: str) -> dict[str, str]:
    """The entries of a flat TOML file (``-``: standard input), see `toml_texts`."""
    return toml_texts(read_text(path, TOML_LIMIT), called(path))


def toml_texts(text: str, source: str) -> dict[str, str]:
    """The entries of a flat TOML document, one a line, as texts: numbers as they stand in the file,
    strings as what they hold, and of ``NAME = {value = ..., source = ...}`` or a table of these two
    both. Raises UserError for anything else, naming the line."""
    texts: dict[str, str] = {}
    lines: dict[str, int] = {}
    tables: dict[str, str] = {}
    table = ""
    for number, line in enumerate(text.split("\n"), 1):
        where = f"{source}, line {number}"
        if len(line) > LONGEST_ENTRY:
            message = f"has more than {LONGEST_ENTRY:,} characters; expected one value a line"
            raise UserError(message, where)
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        if header := re.fullmatch(r"\s*\[([A-Za-z0-9_-]+)\]\s*(#.*)?", line):
            table = header[1]
            if table in lines or table in tables:
                raise UserError(f"{table} is given twice", where)
            tables[table] = where
            continue
        if (match := re.match(_ENTRY, line)) is None:
            if re.match(r"\s*\d+ *[A-Za-z?]", line):
                raise UserError(
                    "is a BASIC program, not a scene; impact88 basic runs it, and run and verify "
                    "take another copy of the listing as --listing",
                    source,
                )
            raise UserError(f"{quoted(line.strip())} is not an entry; expected NAME = VALUE", where)
        key = match[1] or match[2] or match[3] or ""
        if table:
            if key not in ("value", "source"):
                raise UserError(f"{table} is a table; expected a number", where)
            key = table if key == "value" else table + SOURCE
        if key in lines:
            raise UserError(f"{key} is given twice (first in line {lines[key]})", where)
        lines[key] = number
        texts |= _toml_values(key, match[4], where)
    for table, where in tables.items():
        if table not in texts:
            raise UserError(f"{table} is a table; expected a number", where)
    return texts


def _toml_values(key: str, text: str, where: str) -> dict[str, str]:
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
        whole = re.sub(r"\.(?![0-9])", ".0", re.sub(r"^([+-]?)\.", r"\g<1>0.", raw))
        bare = f"{whole} or " if _plain_toml(whole) else ""
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
"""Sides, axes and signs, for people who fill in a scene."""


def template(case: Case | None = None, units: str | None = None) -> str:
    """Return a commented scene file: a case's, its texts as they were written, or one whose numbers
    are left to fill in, bare ones in the system ``units``."""
    from .units import system_of

    system = case.system if case else system_of(units)
    texts = case.texts if case else {"M": DEFAULT_M, "units": units or ""}
    lines = [
        "# A scene for impact88. Any consistent units; angles in degrees, spins in radians per",
        '# unit of time. The digits are used as written. Write 0.911 or ".911": TOML takes no .911',
        "#",
        *(f"# {line}".rstrip() for line in SIGNS.splitlines()),
        "",
        f"title = {_quoted(texts.get('title', ''))}",
        *_about_lines(case.about if case else texts),
    ]
    heading, rest = None, _remaining(texts, SCENE)
    for row in SCENE.values():
        if row.line != heading:
            heading = row.line
            lines += ["", f"# line {heading} of the listing"]
        if row.name not in texts and (own := _in_place_of(row.name, texts)):
            lines += [line for name in own for line in _entry(name, texts, 20, system)]
            rest = [name for name in rest if name not in own]
        elif not _in_place_of(row.name, texts, either=True) or row.name in texts:
            line, *source = _entry(row.name, texts, 20, system)
            mark = ", estimated" if case and row.name in case.estimated else ""
            lines += [line + mark, *source]
    if rest:
        lines += ["", *(line for name in rest for line in _entry(name, texts, 20, system))]
    return "\n".join(lines) + "\n"


def _in_place_of(name: str, texts: Mapping[str, str], either: bool = False) -> tuple[str, ...]:
    """Return the names of the contact point in a vehicle's own axes where they stand for DA or DB,
    or, with ``either``, for PA or PB too."""
    own = OWN_AXES.get(name[1:], ()) if name[0] in "DP" else ()
    stands = set(own) & set(texts) and (either or name[0] == "D")
    return tuple(own) if stands else ()


def known_template(names: Sequence[str], case: Case | None = None, units: str | None = None) -> str:
    """Return a file to fill in with what is known of ``names``; of a ``case`` what is known."""
    from .units import system_of

    system = case.system if case else system_of(units)
    texts = case.texts if case else {"M": DEFAULT_M, "units": units or ""}
    lines = ["# Fill in what is known; what stays empty is solved for. Any consistent units."]
    if texts.get("title"):
        lines.append(f"title = {_quoted(texts['title'])}")
    lines += _about_lines(case.about if case else texts)
    for name in names:
        lines += _entry(name, texts, 12, system, quotes=True)
    for name in _remaining(texts, names) if case else ():
        lines += _entry(name, texts, 12, system, quotes=True)
    return "\n".join(lines)


def _about_lines(texts: Mapping[str, str]) -> list[str]:
    """Return the lines of what is said of the whole file, the title excepted."""
    return [
        f"{name} = {_quoted(texts[name])}" for name in ABOUT if name != "title" and texts.get(name)
    ]


def _remaining(texts: Mapping[str, str], names: Collection[str]) -> list[str]:
    """Return the entries beside ``names``, without notes on sources and on the whole file."""
    return [n for n in texts if n not in names and n not in ABOUT and not n.endswith(SOURCE)]


def _entry(
    name: str, texts: Mapping[str, str], width: int, system: System, quotes: bool = False
) -> list[str]:
    """Return the line of an entry, with its meaning, and that of its source."""
    text = texts.get(name, DEFAULT_M if name == "M" else "")
    entry = f"{name} = {text if _plain_toml(text) and not quotes else _quoted(text)}"
    try:
        row = quantity(name)
    except KeyError:
        lines = [entry]
    else:
        meaning = "signed P_t/P_n, in place of MU" if quotes and name == "MUP" else row.meaning
        symbol = f"{row.symbol}: "
        lines = [f"{entry:<{width}} # {symbol}{meaning} [{system.label(row.unit)}]"]
    if name + SOURCE in texts:
        lines.append(f"{name}{SOURCE} = {_quoted(texts[name + SOURCE])}")
    return lines


def _quoted(text: str) -> str:
    """A text as TOML has it, on one line whatever it holds."""
    line = "".join(character if character.isprintable() else " " for character in text)
    return '"{}"'.format(line.replace("\\", "\\\\").replace('"', '\\"'))


def _plain_toml(text: str) -> bool:
    """Whether TOML takes the number unquoted."""
    return re.fullmatch(r"[+-]?(0|[1-9][0-9]*)(\.[0-9]+)?([eE][+-]?[0-9]+)?", text) is not None
