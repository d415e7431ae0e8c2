"""A scene: the listing's 21 values as the text that was typed, and the files that hold them.

The digits typed are part of the evidence (90315.8817 and 90315.88170 differ in their last bit), so
a scene keeps text; an arithmetic reads it later. The file form is TOML, flat, keyed by the
listing's names; only the raw text of a value is used, never TOML's own idea of the number.
"""

import math
import re
from collections.abc import Collection, Hashable, Iterator, Mapping, Sequence

from . import notebook
from .doubles import BARE, double, is_number
from .errors import BEYOND_DOUBLES, UserError, quoted
from .files import called, packaged_text, read_text
from .names import DEFAULT_M, SCENE, VELOCITIES, check_names, missing, quantity

TOML_LIMIT = 100_000
"""Bytes of the largest scene file that is read: a bound on time; a whole scene has 2,000."""
LONGEST_ENTRY = 2_000
"""Characters of the longest line of a scene file; a TOML reader may be slow with long keys."""
VALUE_LIMIT = 70
"""The longest value: three of them and their commas fit the 239 characters INPUT keeps."""
DATA_LINES, REPLY_LINES, M_LINE = (280, 290, 310), (210, 230), 350
TYPED_LIMIT = 239
"""Lines of the listing that set and ask for values; the characters the Apple takes in a line."""
LISTING = "impact.bas"

_ENTRY = r"""[ \t]*(?:([A-Za-z0-9_-]+)|"([^"]*)"|'([^']*)')[ \t]*=[ \t]*(.*)"""


class Entries:
    """What a file, or a mapping of texts, says of a collision. ``values``: by name, in base units,
    as numbers or within limits, the contact point as DA PA DB PB, inertias estimated where that is
    asked for; ``units``: the name of their system, None where nothing says; ``estimated``: how each
    estimate was found; ``outlines``: LA BA LB BB, in base units; ``sources``: where a value comes
    from, in the file's words; ``remarks``: by name, how entries were understood, for people who see
    the result; ``given``: the entries as written."""

    title: str | None = None
    case: str | None = None

    def __init__(
        self, values: dict[str, str], given: Mapping[str, str], units: str | None = None
    ) -> None:
        self.values, self.given, self.units = values, given, units
        self.estimated: dict[str, str] = {}
        self.outlines: dict[str, float] = {}
        self.sources: dict[str, str] = {}
        self.remarks: dict[str, str] = {}

    def changed(self, changes: Mapping[str, str]) -> "Entries":
        """These entries with some values changed."""
        result = Entries({**self.values, **changes}, {**self.given, **changes}, self.units)
        result.title, result.case, result.outlines = self.title, self.case, self.outlines
        for name in ("estimated", "sources", "remarks"):
            kept = {n: text for n, text in getattr(self, name).items() if n not in changes}
            setattr(result, name, kept)
        return result


class Scene(Mapping[str, str]):
    """The 21 values of a scene by the listing's names, in the table's order, each as typed.

    ``source`` says where it came from (a file's name), for messages; ``units`` names the system of
    units its file was written in (`impact88.units`), whose base units the values are in;
    ``estimated`` says of each value that is an estimate (`impact88.estimates`) how it was found;
    ``entries``: the file's, where it came from one.

    >>> scene = impact88.sample(1).replaced({"MU": ".5"})
    >>> scene["MU"], scene.numbers()["E"]
    ('.5', 0.005)
    """

    __slots__ = ("_values", "entries", "estimated", "source", "title", "units")

    def __init__(
        self,
        values: Mapping[str, str],
        title: str | None = None,
        source: str = "scene",
        units: str | None = None,
        entries: Entries | None = None,
    ) -> None:
        """Raises UserError for a missing or unknown name and for text that is not a number."""
        check_mapping(values)
        given = dict(values)
        given.setdefault("M", DEFAULT_M)
        check_names(given, (*SCENE, "title"), "value of a scene", source)
        absent = [name for name in SCENE if name not in given]
        if absent:
            raise UserError(missing(absent), source)
        entries = entries or Entries(dict(given), dict(given))
        if is_share(given["MU"]):
            from .closedform.share import resolved  # needed for a share only

            checked = {n: check_value(n, text, source) for n, text in given.items() if n != "MU"}
            given["MU"], entries.remarks["MU"] = resolved({**checked, "MU": given["MU"]}, source)
        self._values = {name: check_value(name, given[name], source) for name in SCENE}
        self.title, self.source, self.units = title, source, units
        self.entries, self.estimated = entries, entries.estimated

    @classmethod
    def from_mapping(
        cls, values: Mapping[str, str], source: str = "scene", units: str | None = None
    ) -> "Scene":
        """A scene from texts by name, which may have units; bare numbers are in ``units`` unless an
        entry says otherwise; of a value known within limits, the middle; M defaults to 6. Raises
        UserError."""
        found = entries_of(values, source, units, single=True)
        found.values.pop("correlations", None)
        return cls(found.values, found.title, source, found.units, found)

    @classmethod
    def from_toml(cls, path: str, units: str | None = None) -> "Scene":
        """The same from a TOML file. Raises UserError naming file, line or key."""
        return cls.from_mapping(toml_file(path), called(path), units)

    @classmethod
    def from_toml_text(cls, text: str, source: str, units: str | None = None) -> "Scene":
        """The scene in a TOML document; ``source`` names it in errors."""
        return cls.from_mapping(toml_texts(text, source), source, units)

    def __getitem__(self, name: str) -> str:
        return self._values[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __repr__(self) -> str:
        return f"Scene({self._values!r})"

    def _repr_html_(self) -> str:
        """The scene file, as a notebook shows it."""
        return notebook.preformatted(self.to_toml())

    def replaced(self, changes: Mapping[str, str]) -> "Scene":
        """This scene with some values changed; a share of the critical friction stays that share.
        Raises UserError as the constructor does."""
        entries = self.entries.changed(changes)
        share = {n: text for n, text in entries.values.items() if n == "MU" and is_share(text)}
        values = {**self._values, **changes, **share}
        return Scene(values, self.title, self.source, self.units, entries)

    def keyboard(self) -> list[str]:
        """The replies to the INPUTs of lines 210 and 230."""
        return [",".join(self[n] for n in names) for names in (VELOCITIES[:3], VELOCITIES[3:])]

    def typed_lines(self) -> list[str]:
        """The program lines to retype for this scene: 280, 290, 310, and 350 unless M is 6."""
        lines = [
            f"{line} "
            + ":".join(f"{q.name} = {self[q.name]}" for q in SCENE.values() if q.line == line)
            for line in DATA_LINES
        ]
        if self["M"] != DEFAULT_M:
            lines.append(f"{M_LINE} N = {DEFAULT_M}:M = {self['M']}")
        return lines

    def numbers(self) -> dict[str, float]:
        """The values in double precision. Raises UserError for one past the range of doubles."""
        return numbers_of(self)

    def check_typed(self) -> None:
        """Raises UserError unless the values can be typed into the program's lines and mean there
        what INPUT takes them for: ``E`` is the variable there, ``-`` alone no number, and a line
        has at most 239 characters."""
        for value in SCENE.values():
            text = self[value.name]
            if value.line not in REPLY_LINES and not re.match(r"[ +-]*[0-9.]", text):
                raise UserError(
                    f"{value.name} = {text!r} is a number to INPUT but not in program line "
                    f"{value.line}; expected one that begins with a digit or a point",
                    self.source,
                )
        for line in self.typed_lines():
            if len(line) > TYPED_LIMIT:
                raise UserError(
                    f"program line {line.split()[0]} has {len(line)} characters with these values; "
                    f"the Apple takes {TYPED_LIMIT}",
                    self.source,
                )

    def to_toml(self) -> str:
        """The scene as a commented TOML file, in the units it came in."""
        return template(shown_texts(self, self.units), self.title, self.units, self.estimated)


def numbers_of(scene: Mapping[str, object]) -> dict[str, float]:
    """The scene's values, texts or numbers, as doubles by name. Raises UserError for a missing
    value or one that is not a finite number."""
    result = {}
    for name in SCENE:
        text = scene.get(name, DEFAULT_M if name == "M" else None)
        try:
            value = double(text) if isinstance(text, str) else float(text)  # type: ignore[arg-type]
        except (TypeError, ValueError):
            value = math.nan
        if not math.isfinite(value):
            raise UserError(f"{text!r} is not a finite number", name)
        result[name] = value
    return result


OWN_AXES = {"A": ("CAF", "CAL"), "B": ("CBF", "CBL")}


def _with_contact_point(values: dict[str, str], source: str) -> dict[str, str]:
    """The values with DA PA or DB PB worked out from CAF CAL or CBF CBL, forward and to the left of
    the center of gravity. Within limits they stay, for `reconstruction.geometry.moved`."""
    for vehicle, names in OWN_AXES.items():
        absent = [name for name in names if name not in values]
        if len(absent) == len(names):
            continue
        if absent:
            raise UserError(f"{absent[0]} is missing beside {' '.join(names)}", source)
        both = [name for name in (f"D{vehicle}", f"P{vehicle}") if name in values]
        if both:
            raise UserError(f"{both[0]} and {names[0]} are both given; expected one pair", source)
        if any(_is_range(values[name]) for name in names):
            continue
        forward, left = (double(check_value(name, values.pop(name), source)) for name in names)
        distance = math.hypot(forward, left)
        if math.isinf(distance):
            raise UserError(f"{' '.join(names)}: {BEYOND_DOUBLES}", source)
        values[f"D{vehicle}"] = repr(distance).upper()
        values[f"P{vehicle}"] = repr(math.degrees(math.atan2(left, forward))).upper()
    return values


def check_mapping(values: object) -> None:
    """Raises UserError for what is not a mapping of names, such as the name of a file."""
    if not isinstance(values, Mapping) or not all(isinstance(name, str) for name in values):
        hint = ", such as impact88.Scene.from_toml(...)" if isinstance(values, str) else ""
        raise UserError(f"{quoted(values)}: expected a mapping of names to values{hint}")


_NO_AMOUNTS = ("title", "case", "correlations", "M")
SOURCE = "_source"
"""The end of an entry that says where a value comes from: UX_source = "event data recorder"."""
RANGES = ("..", "+-", "±", "+/-", "uniform", "triangular", "normal")
"""What marks a value known within limits."""
_SIZES = frozenset(("LA", "BA", "LB", "BB"))


def entries_of(
    texts: Mapping[str, str], source: str, units: str | None = None, single: bool = False
) -> Entries:
    """The entries of a file, see `Entries`; ``units``: the system of bare numbers where it names
    none; ``single``: the middle of each value known within limits. Raises UserError."""
    check_mapping(texts)
    given = {name: text for name, text in texts.items() if not name.endswith(SOURCE)}
    for name, text in given.items():
        if not isinstance(text, str):
            raise UserError(f"{name} is {text!r}; expected the number's text", source)
    values, system = in_base_units(given, source, units)
    found = Entries(values, given, system)
    found.sources = {n.removesuffix(SOURCE): t for n, t in texts.items() if n not in given}
    for name in found.sources:
        if name not in given:
            raise UserError(f"{name}{SOURCE} is given, and {name} is not", source)
    found.title, found.case = values.pop("title", None), values.pop("case", None)
    uncertain = [n for n, text in values.items() if n != "correlations" and _is_range(text)]
    if system or (uncertain and single):
        from .units import nominal, remarks

        found.remarks = remarks(given, system)
    for name in uncertain if single else ():
        values[name] = nominal(name, values[name], source)
        found.remarks[name] = f"{name} = {given[name]}: its middle is used"
    if not _SIZES.isdisjoint(values) or any(
        values.get(name, "").startswith("estimate") for name in ("IA", "IB")
    ):
        from .estimates import with_estimates
        from .units import nominal

        values, found.estimated, found.outlines = with_estimates(values, source, system)
        for name, rule in found.estimated.items():
            found.remarks[name] = f"{name} = {values[name]} is estimated: {rule}"
        for name in found.estimated if single else ():
            values[name] = nominal(name, values[name], source)
    found.values = _with_contact_point(values, source)
    return found


def entries_in(path: str, units: str | None = None, single: bool = False) -> Entries:
    """The entries of a TOML file (``-``: standard input), see `entries_of`."""
    return entries_of(toml_file(path), called(path), units, single)


def is_share(text: object) -> bool:
    """Whether MU is a share of the critical friction, such as ``85 %``."""
    return isinstance(text, str) and text.endswith("%")


def _is_range(text: str) -> bool:
    return any(mark in text for mark in RANGES) and not text.startswith("estimate")


def in_base_units(
    texts: Mapping[str, str], source: str, units: str | None = None
) -> tuple[dict[str, str], str | None]:
    """The texts in base units (`impact88.units`), and the system's name; as they are where no
    value, nor the entry ``units``, nor ``units`` names any. Raises UserError."""
    if units is None and all(BARE.issuperset(texts[n]) for n in texts if n not in _NO_AMOUNTS):
        return dict(texts), None
    from .units import in_base

    return in_base(texts, source, units)


def check_value(name: str, text: str, source: str | None) -> str:
    """``text`` if INPUT would take it for a number; ``name`` is any table's. Raises UserError."""
    if not isinstance(text, str):
        raise UserError(f"{name} is {text!r}; expected the number's text", source)
    if not is_number(text):
        raise UserError(
            f"{name} = {text!r} is not a number; expected one such as 1.5 "
            f"({quantity(name).meaning})",
            source,
        )
    if len(text) > VALUE_LIMIT:
        raise UserError(f"{name} has more than {VALUE_LIMIT} characters", source)
    return text


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


def shown_texts(texts: Mapping[str, str], units: str | None) -> dict[str, str]:
    """Numbers in base units as bare numbers of the system of that name."""
    from .units import shown_text, system_of

    return {name: shown_text(name, text, system_of(units)) for name, text in texts.items()}


def template(
    values: Mapping[str, str] | None = None,
    title: str | None = None,
    units: str | None = None,
    estimated: Collection[str] = (),
) -> str:
    """A commented scene file; without ``values`` the numbers are left to fill in; ``units``: the
    system of its bare numbers (`impact88.units`); ``estimated``: names marked as estimates."""
    from .units import system_of

    lines = [
        "# A scene for impact88. Any consistent units; angles in degrees, spins in radians per",
        '# unit of time. The digits are used as written. Write 0.911 or ".911": TOML takes no .911',
        "#",
        *(f"# {line}".rstrip() for line in SIGNS.splitlines()),
        "",
        f"title = {_quoted(title or '')}",
        *([f"units = {_quoted(units)}"] if units else []),
    ]
    heading = None
    for row in SCENE.values():
        if row.line != heading:
            heading = row.line
            lines += ["", f"# line {heading} of the listing"]
        text = values[row.name] if values else (DEFAULT_M if row.name == "M" else "")
        entry = f"{row.name} = {text if _plain_toml(text) else _quoted(text)}"
        mark = ", estimated" if row.name in estimated else ""
        unit = system_of(units).label(row.unit)
        lines.append(f"{entry:<20} # {row.symbol}: {row.meaning} [{unit}]{mark}")
    return "\n".join(lines) + "\n"


def known_template(
    names: Sequence[str], values: Mapping[str, str] | None = None, units: str | None = None
) -> str:
    """A file to fill in with what is known of ``names``; ``values``: what is known already."""
    from .units import system_of

    known = {"M": DEFAULT_M} if values is None else values
    lines = ["# Fill in what is known; what stays empty is solved for. Any consistent units."]
    if units:
        lines.append(f"units = {_quoted(units)}")
    for name in names:
        row = quantity(name)
        meaning = "signed P_t/P_n, in place of MU" if name == "MUP" else row.meaning
        entry = f"{name} = {_quoted(known.get(name, ''))}"
        lines.append(f"{entry:<12} # {row.symbol}: {meaning} [{system_of(units).label(row.unit)}]")
    return "\n".join(lines)


def _quoted(text: str) -> str:
    """A text as TOML has it, on one line whatever it holds."""
    line = "".join(character if character.isprintable() else " " for character in text)
    return '"{}"'.format(line.replace("\\", "\\\\").replace('"', '\\"'))


def _plain_toml(text: str) -> bool:
    """Whether TOML takes the number unquoted."""
    return re.fullmatch(r"[+-]?(0|[1-9][0-9]*)(\.[0-9]+)?([eE][+-]?[0-9]+)?", text) is not None


def published_data() -> dict[str, str]:
    """The values in the published listing's own lines 280, 290, 310 and 350."""
    data: dict[str, str] = {}
    for line in packaged_text("impact88.legacy", LISTING).splitlines():
        number, _, statements = line.partition(" ")
        if int(number) in (*DATA_LINES, M_LINE):
            given = statements.partition(": REM")[0].split(":")
            data |= dict(statement.split(" = ") for statement in given)
    return {name: data[name] for name in SCENE if name in data}


_APPENDIX = "UX=-29.04 UY=0 WA=0 VX=14.52 VY=25.15 WB=0"
_SAMPLES = {
    1: ("Appendix, first sample run", _APPENDIX),
    2: ("Appendix, second sample run: point masses", f"{_APPENDIX} M=4 DA=0 DB=0"),
    3: (
        "Table 3: hypothetical collision for example calculations",
        "UX=-36.667 UY=0 WA=0 VX=0 VY=58.667 WB=0 E=.25 MU=.89 EM=-.9 DA=4.5 DB=4 "
        "GA=0 PA=0 PB=-40 TA=0 TB=90 MA=96 MB=145 IA=1970 IB=3770",
    ),
}
"""The published runs: title, and what is typed beside the listing's own data."""

SAMPLES = tuple(_SAMPLES)


def sample(number: int) -> "Scene":
    """The scene of published run 1, 2 or 3. Raises UserError for another number.

    >>> impact88.sample(2)["M"]
    '4'
    """
    if not isinstance(number, Hashable) or number not in _SAMPLES:
        raise UserError(f"there is no sample {number}; expected {', '.join(map(str, SAMPLES))}")
    title, typed = _SAMPLES[number]
    values = published_data() | dict(entry.split("=") for entry in typed.split())
    return Scene(values, title, f"sample {number}")
