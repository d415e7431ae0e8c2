"""A case: the entries of a file, published run, form or mapping about one collision, resolved once.

Every entry point (a command, the desk, a table's scene, a Python function) reads its values from a
case. A case keeps the text of each entry as written and is immutable; `Case.replaced` returns the
case of the edited file. So ``COMMAND FILE --set K=V`` gives the same result as editing that line of
FILE, for every command and every kind of value.
"""

from __future__ import annotations

import math
import re
from collections import namedtuple
from collections.abc import Mapping
from contextlib import suppress
from functools import cached_property
from types import MappingProxyType

from ..errors import BEYOND_DOUBLES, UserError, quoted
from ..names import DEFAULT_M, NO_AMOUNTS, quantity
from .doubles import BARE, digits, double, double_or_none, is_number

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Self

    from .units import Convention, System

VALUE_LIMIT = 70
"""Characters of the longest value: three with their commas fit the 239 that INPUT keeps."""
OWN_AXES = {"A": ("CAF", "CAL"), "B": ("CBF", "CBL")}
"""The contact point in each vehicle's own axes, given in place of DA PA and DB PB."""
OWN_NAMES = ("CAF", "CAL", "CBF", "CBL", "LA", "BA", "LB", "BB")
"""Entries that replace values of a scene, give sizes to estimate an inertia, or an outline."""
SOURCE = "_source"
"""Suffix of an entry that says where a value comes from: UX_source = "event data recorder"."""
RANGES = ("..", "+-", "±", "+/-", "uniform", "triangular", "normal")
"""Marks of a value known within limits."""
ESTIMATE = "estimate"
"""The word for an unknown yaw inertia, see `collision.estimates`."""
FACING_COURSE = "course"
"""TA or TB of a vehicle that faces the way it travels."""
LOCKED = "locked"
"""MU of vehicles whose contact points move together after the impact, beside E = 0."""
LOCKED_MU = "-10"
TOLERANCES = ("+-", "±", "+/-")
"""Marks that begin a tolerance around the value already given."""
ABOUT = ("title", "case", "examiner", "date", "correlations", "units", "axes", "headings")
"""Entries about the whole file."""
_SHARE = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+))\s*%\s*")
_TOLERANCE = re.compile("|".join(map(re.escape, TOLERANCES)))
_SIZES = frozenset(("LA", "BA", "LB", "BB"))
_MOVES = ("CX", "CY")


class Entry(namedtuple("Entry", "name text kind unit base source")):
    """One value of a case.

    ``text``: as written; ``kind``: "value", "range", "tolerance", "share" (a percentage of the
    critical friction) or "estimate"; ``unit``: the unit it is written in (for a bare number that of
    the system, "" if there is none); ``base``: the text in base units and the listing's axes;
    ``source``: the file's note on where the value comes from."""

    __slots__ = ()


class Case:
    """The entries about one collision and the values they resolve to.

    Parameters
    ----------
    texts
        The entries by name, as written: values, ``title``, ``case``, ``units``, ``axes``,
        ``headings``, ``correlations``, and NAME_source.
    source
        Name of the file in messages.
    units, axes, headings
        Defaults for entries the texts do not have (``--units``, ``--axes``, ``--headings``).
    single
        Use the nominal value (middle, mode or mean) of each value known within limits.

    Attributes
    ----------
    values : dict
        Texts by name, in base units and the listing's axes: numbers, ranges or percentages of the
        critical friction. Inertias are estimated; the contact point is DA PA DB PB (CAF CAL CBF CBL
        if those are known within limits); M defaults to 6.
    system : System
        The units and directions that values are shown in.
    estimated : dict
        The rule behind each estimate, in words.
    outlines : dict
        LA BA LB BB, in base units.
    remarks : dict
        By name, how entries were understood, and which values are implausible: one remark a line
        (`remark_lines`).

    Raises
    ------
    UserError
        If a text is not an amount, a unit does not measure the quantity, bare numbers stand among
        amounts with units and no system is named, or one of a pair of entries is missing.
    """

    def __init__(
        self,
        texts: Mapping[str, str],
        source: str = "scene",
        units: str | None = None,
        axes: str | None = None,
        headings: str | None = None,
        single: bool = False,
    ) -> None:
        check_mapping(texts)
        if not isinstance(source, str):
            raise UserError(f"source is {quoted(source)}; expected what messages call the scene")
        for name, text in texts.items():
            if not isinstance(text, str):
                raise UserError(f"{name} is {text!r}; expected the number's text", source)
        self.texts: Mapping[str, str] = MappingProxyType(dict(texts))
        self.source, self.is_single = source, single
        self._options = (units, axes, headings)
        self._places: dict[str, str] = {}
        entries = {n: t for n, t in texts.items() if t.strip() and not n.endswith(SOURCE)}
        self.sources = {n.removesuffix(SOURCE): t for n, t in texts.items() if n.endswith(SOURCE)}
        for name in self.sources:
            if name not in texts:
                raise UserError(f"{name}{SOURCE} is given, and {name} is not", source)
        self.given: Mapping[str, str] = MappingProxyType(entries)
        self.title, self.case = entries.get("title"), entries.get("case")
        self.correlations = entries.get("correlations", "")
        axes, headings = entries.get("axes", axes), entries.get("headings", headings)
        self._convention: Convention | None = None
        if axes or headings:
            from .units import convention_named

            self._convention = convention_named(axes, headings, source)
        amounts = {
            n: LOCKED_MU if n in ("MU", "MUP") and t.strip().lower() == LOCKED else t
            for n, t in entries.items()
            if n not in ABOUT or n == "units"
        }
        base_texts, self.units = in_base_units(amounts, source, units)
        if self._convention:
            from .units import in_listing_axes

            base_texts = in_listing_axes(base_texts, self.system, source)
        self._based: Mapping[str, str] = MappingProxyType(dict(base_texts))
        self.estimated: dict[str, str] = {}
        self.outlines: dict[str, float] = {}
        self.remarks: dict[str, str] = {}
        self.values = {**base_texts, "M": base_texts.get("M", DEFAULT_M)}
        self._resolve()

    @cached_property
    def system(self) -> System:
        """The units and directions that values are shown in."""
        from .units import system_of

        system = system_of(self.units)
        return system._replace(convention=self._convention) if self._convention else system

    def _resolve(self) -> None:
        """Replace ranges if asked, estimate inertias, and compute DA PA DB PB."""
        values, source = self.values, self.source
        uncertain = [name for name, text in values.items() if is_range(text)]
        if self.units or uncertain:
            from .units import nominal, remarks

            self.remarks |= remarks(self.given, self.units)
        for name in uncertain if self.is_single else ():
            values[name] = nominal(name, values[name], source)
            self.remarks[name] = f"{name} = {self.given[name]}: its middle is used"
        if not _SIZES.isdisjoint(values) or any(
            values.get(name, "").startswith(ESTIMATE) for name in ("IA", "IB")
        ):
            from .estimates import with_estimates
            from .units import nominal

            values, self.estimated, self.outlines = with_estimates(values, source, self.units)
            for name, rule in self.estimated.items():
                text = self.display_texts({name: values[name]})[name]
                amount = f"{text} {self.system.unit(name)}".rstrip()
                self.remarks[name] = f"{name} = {amount} is estimated: {rule}"
            for name in self.estimated if self.is_single else ():
                values[name] = nominal(name, values[name], source)
        self.values = _with_headings(_with_contact_point(values, source))
        self._remark()

    def _remark(self) -> None:
        """Add remarks on implausible values."""
        from . import plausibility

        numbers: dict[str, float] = {}
        for name, text in self.values.items():
            if is_number(text):
                numbers[name] = double(text)
            elif is_range(text) and not self.is_single:
                from .units import nominal

                with suppress(ValueError):  # reported by the code that reads the entry
                    numbers[name] = double(nominal(name, text, self.source))
        system = self.system if self.units else None
        new_remarks = plausibility.remarks(numbers, self.given, system, self.outlines)
        for name, text in new_remarks.items():
            earlier = self.remarks.get(name)
            self.remarks[name] = f"{earlier}\n{text}" if earlier else text

    def __repr__(self) -> str:
        return f"Case({dict(self.texts)!r}, {self.source!r})"

    @property
    def of_points(self) -> bool:
        """True where M is 4, however it is written: point masses."""
        return double_or_none(self.values["M"]) == 4

    @property
    def entries(self) -> dict[str, Entry]:
        """The values, each with its text, kind, unit, base-unit value and source note."""
        return {
            name: Entry(
                name,
                text,
                kind_of(name, text),
                self._unit(name, text),
                self._based[name],
                self.sources.get(name, ""),
            )
            for name, text in self.given.items()
            if name not in ABOUT
        }

    def _unit(self, name: str, text: str) -> str:
        from .units import units_in

        units = [unit for unit, _ in units_in(name, text)]
        try:
            return units[0] if units else self.system.unit(name)
        except KeyError:
            return ""

    def replaced(self, changes: Mapping[str, str], where: str | None = None) -> Self:
        """Return the case of the edited file.

        Parameters
        ----------
        changes
            New text by name, as in a file. An empty text removes the entry; one that begins with
            ``+-`` puts a tolerance around the present value.
        where
            Name of the changes in messages, such as ``--set``.
        """
        from .units import middle_of, units_in

        texts, new_texts = dict(self.texts), {}
        for name, text in changes.items():
            if isinstance(text, str) and text.strip().startswith(TOLERANCES):
                before = self.given.get(name) or ("0" if name in _MOVES else "")
                middle = middle_of(name, before, self.system, self.source) if before else ""
                if middle and units_in(name, text) and not units_in(name, middle):
                    middle += f" {self.system.unit(name)}"
                text = f"{middle} {text.strip()}".strip()
            new_texts[name] = text
            texts.pop(name + SOURCE, None)
            if isinstance(text, str) and not text.strip():
                texts.pop(name, None)
            else:
                texts[name] = text
        place = where or self.source
        amounts = {n: t for n, t in new_texts.items() if n not in ABOUT and not n.endswith(SOURCE)}
        for name, text in amounts.items():
            if not isinstance(text, str):
                raise UserError(f"{name} is {text!r}; expected the number's text", place)
        in_base_units(amounts, place, texts.get("units") or self.units)
        return self._with_texts(texts, {**self._places, **dict.fromkeys(new_texts, place)})

    def _with_texts(
        self, texts: Mapping[str, str], places: Mapping[str, str], single: bool | None = None
    ) -> Self:
        """Return the case of other texts; ``places``: the origins of changed entries."""
        units, axes, headings = self._options
        single = self.is_single if single is None else single
        case = type(self)(texts, self.source, units, axes, headings, single)
        case._places = dict(places)
        return case

    def place(self, name: str) -> str:
        """Return the origin of a value for messages: the file, or an option."""
        return self._places.get(name, self.source)

    def with_sources(self, notes: Mapping[str, str]) -> Self:
        """Return this case with notes on the origin of values, by name."""
        texts = {**self.texts, **{name + SOURCE: text for name, text in notes.items()}}
        return self._with_texts(texts, self._places)

    def shown_in(
        self, units: str | None, axes: str | None = None, headings: str | None = None
    ) -> Self:
        """Return this case with its numbers rewritten in another system or other directions; None
        leaves that unchanged. Raises UserError."""
        if not (units or axes or headings):
            return self
        options = {"units": units, "axes": axes, "headings": headings}
        about = {name: text for name, text in options.items() if text}
        target = type(self)({**self.about, **about}, self.source)
        numbers = {
            name: self._in_base_of(target.system, name, text)
            for name, text in self._based.items()
            if is_number(text)
        }
        return type(self)({**self.texts, **target.display_texts(numbers), **about}, self.source)

    def _in_base_of(self, system: System, name: str, text: str) -> str:
        """Return a number in base units of this case in those of another system."""
        if self.system.is_bare or system.is_bare or self.system.base == system.base:
            return text
        rule = quantity(name).unit
        factor = float(self.system.scale(rule) / system.scale(rule))
        return text if factor == 1 else f"{double(text) * factor:.15g}".upper()

    def at_nominal(self) -> Self:
        """Return this case with the nominal value of each value known within limits."""
        if self.is_single:
            return self
        return self._with_texts(self.texts, self._places, single=True)

    def display_texts(self, values: Mapping[str, float | str]) -> dict[str, str]:
        """Return values in base units and the listing's axes as texts of this case: bare numbers in
        its units and directions."""
        from .units import shown_text

        texts = {n: v if isinstance(v, str) else repr(v).upper() for n, v in values.items()}
        return {name: shown_text(name, text, self.system) for name, text in texts.items()}

    @property
    def named_units(self) -> str | None:
        """The system that the file or an option names; None if it only follows from the units."""
        return self.units if "units" in self.given or self._options[0] else None

    @property
    def about(self) -> dict[str, str]:
        """The entries about the whole file, options included, as a file has them."""
        _, axes, headings = self._options
        options = {"units": self.named_units, "axes": axes, "headings": headings}
        texts = {name: self.given.get(name) or options.get(name) or "" for name in ABOUT}
        return {name: text for name, text in texts.items() if text}


def remark_lines(remarks: Mapping[str, str]) -> list[str]:
    """Return a case's or a scene's remarks, one a line and each once."""
    return list(dict.fromkeys(line for text in remarks.values() for line in text.split("\n")))


def kind_of(name: str, text: str) -> str:
    """Return the kind of an entry: "value", "range", "tolerance", "share" or "estimate"."""
    words = text.strip()
    if words.startswith(ESTIMATE):
        return ESTIMATE
    if name in ("MU", "MUP") and "%" in _TOLERANCE.split(words)[0]:
        return "share"
    if any(mark in words for mark in TOLERANCES):
        return "tolerance"
    return "range" if is_range(words) else "value"


def case_of(values: object) -> Case | None:
    """Return the case behind a `Scene`, whose values are already in base units; None for any other
    mapping."""
    case = getattr(values, "case", None)
    return case if isinstance(case, Case) else None


def share_of(text: object) -> float | None:
    """Return the fraction of the critical friction that an MU such as ``85 %`` stands for, 0.85;
    None for anything else."""
    match = _SHARE.fullmatch(text) if isinstance(text, str) else None
    return float(match[1]) / 100 if match else None


def is_range(text: str) -> bool:
    """Return True if a text is a value known within limits; estimates are not."""
    return any(mark in text for mark in RANGES) and not text.startswith(ESTIMATE)


def check_mapping(values: object) -> None:
    """Raise UserError unless ``values`` is a mapping with text keys."""
    if not isinstance(values, Mapping) or not all(isinstance(name, str) for name in values):
        hint = ", such as impact88.Scene.from_toml(...)" if isinstance(values, str) else ""
        raise UserError(f"{quoted(values)}: expected a mapping of names to values{hint}")


def check_value(name: str, text: str, source: str | None) -> str:
    """Return ``text`` if INPUT reads it as one number; ``name``: of any table. Raises UserError."""
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


def in_base_units(
    texts: Mapping[str, str], source: str, units: str | None = None
) -> tuple[dict[str, str], str | None]:
    """Return the texts in base units, and the name of their system.

    Without any unit, ``units`` entry or ``units`` argument the texts are returned unchanged, with
    None. Raises UserError, see `collision.units.in_base`."""
    if units is None and all(BARE.issuperset(texts[n]) for n in texts if n not in NO_AMOUNTS):
        return dict(texts), None
    from .units import in_base

    return in_base(texts, source, units)


def _with_headings(values: dict[str, str]) -> dict[str, str]:
    """Return the values with the numbers of TA and TB that are `FACING_COURSE`, where the course is
    known exactly; where it is not, as of a vehicle at rest, the word stays."""
    if FACING_COURSE not in values.values():
        return values
    from .plausibility import courses_of

    result = dict(values)
    numbers = {name: double(text) for name, text in values.items() if is_number(text)}
    courses = courses_of(numbers)
    for vehicle in "AB":
        if values.get(f"T{vehicle}", "").strip() != FACING_COURSE:
            continue
        result[f"T{vehicle}"] = FACING_COURSE
        if vehicle in courses:
            theta = courses[vehicle] + 180 if vehicle == "A" else courses[vehicle]
            result[f"T{vehicle}"] = digits(math.remainder(theta, 360))
    return result


def _with_contact_point(values: dict[str, str], source: str) -> dict[str, str]:
    """Return the values with DA PA (DB PB) computed from CAF CAL (CBF CBL), the contact point
    forward and to the left of the center of gravity. Ranges are left for
    `geometry.resolve_contact_point`."""
    for vehicle, names in OWN_AXES.items():
        absent = [name for name in names if name not in values]
        if len(absent) == len(names):
            continue
        if absent:
            raise UserError(f"{absent[0]} is missing beside {' '.join(names)}", source)
        polar = [name for name in (f"D{vehicle}", f"P{vehicle}") if name in values]
        if polar:
            raise UserError(f"{polar[0]} and {names[0]} are both given; expected one pair", source)
        if any(is_range(values[name]) for name in names):
            continue
        forward, leftward = (double(check_value(name, values.pop(name), source)) for name in names)
        distance = math.hypot(forward, leftward)
        if math.isinf(distance):
            raise UserError(f"{' '.join(names)}: {BEYOND_DOUBLES}", source)
        values[f"D{vehicle}"] = repr(distance).upper()
        values[f"P{vehicle}"] = repr(math.degrees(math.atan2(leftward, forward))).upper()
    return values
