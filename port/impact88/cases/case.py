"""A case: what a file, a form or a mapping says of one collision, as immutable amounts.

Every command reads its values from a case. It keeps the text of each entry as written, and
`Case.with_` returns the case of the edited file: ``COMMAND FILE --set K=V`` gives what editing that
line of FILE gives."""

from __future__ import annotations

import math
from collections.abc import Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, fields, replace
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from ..decimals import is_number, to_double, to_text
from ..errors import UserError, quoted
from ..files import decode, display_name, read_bytes
from ..names import DEFAULT_M, PIVOT, SCENE, did_you_mean, quantity
from .amounts import TOLERANCE, Amount, normalize, read, units_in
from .estimates import estimate
from .motion import contact_point, courses, headings, line_of_motion
from .plausibility import implausible
from .scenefile import ABOUT, INPUTS, MAX_BYTES, SOURCE, read_toml, write_toml
from .units import DIMENSIONS, PLAIN, View, system_using

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

ESTIMATE = "estimate"
COURSE = "course"
LOCKED = "locked"
OPTIONAL_OF_POINTS = "DA DB PA PB TA TB IA IB EM GA E MU WA WB".split()
"""Inputs that a scene of point masses need not have."""
MOVES = ("CX", "CY")
SIZES = {"A": ("LA", "BA"), "B": ("LB", "BB")}
"""Length and width of each vehicle: for an estimate of its inertia, and its outline in drawings."""
MAX_TYPED = 70  # characters of a value; three and their commas fit the 239 that INPUT keeps


@dataclass(frozen=True)
class Case:
    """One collision.

    Made by `Case.load`, `Case.loads` and `Case.of`.

    Parameters
    ----------
    entries : mapping of str to Amount
        Amounts by name, in base units along the listing's axes. A TA or TB that follows a course
        not yet known is NaN, with the text "course". M is 6 if it is not given.
    view : View
        Units, axes and headings in which the case is written and its results are shown.
    texts : mapping of str to str
        The digits typed into the 1988 program, by the scene's names: nominal values in base units.
    remarks : tuple of str
        What was assumed, and values that are implausible.
    title, case, examiner, date : str
        Headings of a report.
    written : mapping of str to str
        The entries as written.
    source : str
        Name of the case in messages.
    sources : mapping of str to str
        Notes on where values come from.
    sizes : mapping of str to Amount
        LA BA LB BB, in base units.
    estimated : tuple of str
        Yaw inertias that are estimates.
    omitted : tuple of str
        Names of ``texts`` that are typed though the scene of point masses does not give them.
    places : mapping of str to str
        Places of entries for messages.

    Examples
    --------
    >>> case = Case.loads('units = "us"\\nMA = 3000\\nUX = "30 +- 2"')
    >>> case.entries["UX"].high, case.view.shown("UX", case.entries["UX"].high)
    (46.93333333333333, 32.0)
    >>> case.with_(UX="-25 mph").texts["UX"]
    '-36.666666666666664'
    """

    entries: Mapping[str, Amount]
    view: View = PLAIN
    texts: Mapping[str, str] = field(default_factory=dict)
    remarks: tuple[str, ...] = ()
    title: str = ""
    case: str = ""
    examiner: str = ""
    date: str = ""
    written: Mapping[str, str | Amount] = field(default_factory=dict)
    source: str = "scene"
    sources: Mapping[str, str] = field(default_factory=dict)
    sizes: Mapping[str, Amount] = field(default_factory=dict)
    estimated: tuple[str, ...] = ()
    omitted: tuple[str, ...] = ()
    places: Mapping[str, str] = field(default_factory=dict, repr=False, compare=False)
    defaults: View = field(default=PLAIN, repr=False)

    def __post_init__(self) -> None:
        for name, value in vars(self).copy().items():
            if isinstance(value, dict):  # a case does not change
                object.__setattr__(self, name, MappingProxyType(value))

    @classmethod
    def load(cls, path: str, **view: str | None) -> Case:
        """Return the case in a TOML file.

        Parameters
        ----------
        path : str
            The file, ``-`` for standard input.
        **view : str or None
            ``units``, ``axes`` and ``headings`` of a file that names none.

        Raises
        ------
        UserError
            For a file that cannot be read as a case; the message names file, line and entry.
        """
        source = display_name(path)
        return cls.loads(decode(read_bytes(path, MAX_BYTES), source), source, **view)

    @classmethod
    def loads(cls, text: str, source: str = "scene", **view: str | None) -> Case:
        """Return the case in the text of a TOML file.

        Parameters
        ----------
        text : str
            The document.
        source : str, default "scene"
            Its name in messages.
        **view : str or None
            See `load`.

        Raises
        ------
        UserError
            See `load`.
        """
        texts, lines = read_toml(text, source)
        places = {name: f"{source}, line {number}" for name, number in lines.items()}
        return cls.of(texts, source, View.of(**view), places)

    @classmethod
    def of(
        cls,
        entries: Mapping[str, Any],
        source: str = "scene",
        view: View = PLAIN,
        places: Mapping[str, str] | None = None,
        is_inferred: bool = False,
    ) -> Case:
        """Return the case of entries by name.

        Parameters
        ----------
        entries : mapping of str to str, float or Amount
            As in a file; numbers and amounts are in the units and along the axes of the view.
            Empty texts and None stand for nothing.
        source : str, default "scene"
            Name of the case in messages.
        view : View, optional
            The view of entries that name none.
        places : mapping of str to str, optional
            Places of entries for messages.
        is_inferred : bool, default False
            True if units beside other values name the view: a number without is refused.

        Raises
        ------
        UserError
            For an unknown name, a text that is not an amount, units of two systems, a bare number
            among units, and entries that contradict one another.
        """
        return _Reader(entries, source, view, places or {}, is_inferred).case()

    def with_(
        self, changes: Mapping[str, Any] | None = None, where: str = "", **entries: Any
    ) -> Case:
        """Return the case of the edited file.

        Parameters
        ----------
        changes : mapping of str to str, float or Amount, optional
            New entries by name. An empty text removes the entry; one that begins with ``+-`` puts
            a tolerance around the present value.
        where : str, optional
            Place of the changes in messages, such as ``--set``.
        **entries
            More of them.

        Raises
        ------
        UserError
            See `of`.
        """
        texts: dict[str, Any] = dict(self.written)
        changes = {**(changes or {}), **entries}
        for name, value in changes.items():
            text = normalize(value) if isinstance(value, str) else value
            if isinstance(text, str) and text.startswith(TOLERANCE):
                text = f"{self._middle(name)} {text}"
            texts[name] = text
            if name + SOURCE not in changes:
                texts.pop(name + SOURCE, None)
        places = {**self.places, **dict.fromkeys(changes, where)} if where else self.places
        return Case.of(texts, self.source, self.defaults, places)

    def _middle(self, name: str) -> str:
        """Return the present value of an entry as text, to put a tolerance around."""
        text = str(self.written.get(name, "0" if name in MOVES else ""))
        amount = self.entries.get(name)
        if amount is None or amount.share:
            return text
        if text.startswith(ESTIMATE):
            return ESTIMATE
        return f"{self.view.shown_text(name, amount.value)} {self.view.unit(name)}"

    @property
    def numbers(self) -> dict[str, float]:
        """The scene's nominal values in base units, for `mechanics.solve`."""
        return {n: _double(text) for n, text in self.texts.items() if n not in self.omitted}

    @property
    def ranges(self) -> tuple[str, ...]:
        """Names of the values known within limits."""
        return tuple(name for name, amount in self.entries.items() if amount.varies)

    @property
    def correlations(self) -> dict[tuple[str, str], float]:
        """Correlations of values known within limits, by pairs of names.

        Raises
        ------
        UserError
            For a text other than ``"UX,VX 0.5; MA,IA 0.9"``.
        """
        pairs: dict[tuple[str, str], float] = {}
        for part in str(self.written.get("correlations", "")).split(";"):
            words = part.replace(",", " ").split()
            if not words:
                continue
            try:
                first, second, number = words
                pairs[first, second] = float(number)
            except ValueError:
                message = f'correlations: {quoted(part.strip())}; expected such as "UX,VX 0.5"'
                raise UserError(message, self.source) from None
        return pairs

    def place(self, name: str) -> str:
        """Return the place of an entry for messages: file and line, or an option."""
        return self.places.get(name, self.source)

    def toml(self) -> str:
        """Return the case as a commented scene file, entries as written."""
        texts = {name: written_text(value) for name, value in self.written.items()}
        return write_toml({**self.view.words(), **texts}, view=self.view)


def written_text(value: str | Amount) -> str:
    """Return an entry as text; an amount in the notation of a file."""
    if isinstance(value, str):
        return value
    numbers = (value.low, value.value, value.high, value.sd)
    low, middle, high, sd = (to_text(100 * x if value.share else x) for x in numbers)
    texts = {
        "exact": middle,
        "uniform": f"{low} .. {high}",
        "triangular": f"triangular {low} {middle} {high}",
        "normal": f"normal {middle} {sd}",
    }
    return texts[value.kind] + " %" * value.share


class _Reader:
    """The reading of a case's entries."""

    def __init__(
        self,
        entries: Mapping[str, Any],
        source: str,
        view: View,
        places: Mapping[str, str],
        is_inferred: bool,
    ) -> None:
        if not isinstance(entries, Mapping) or not all(isinstance(n, str) for n in entries):
            raise UserError(f"{quoted(entries)}: expected a mapping of names to values")
        self.source, self.places, self.defaults = source, places, view
        self.written = {n: v for n, value in entries.items() if (v := _entry(n, value)) != ""}
        self.given = dict(self.written)
        self.about = {n: str(self.given.pop(n)) for n in ABOUT if n in self.given}
        names = [name for name in self.given if name.endswith(SOURCE)]
        self.sources = {n.removesuffix(SOURCE): str(self.given.pop(n)) for n in names}
        self.entries: dict[str, Amount] = {}
        self.sizes: dict[str, Amount] = {}
        self.estimated: list[str] = []
        self.remarks: list[str] = []
        self.is_inferred = is_inferred

    def case(self) -> Case:
        """Return the case."""
        self._check_names()
        words = {n: self.about[n] for n in ("units", "axes", "headings") if n in self.about}
        file_view = View.of(self.source, **words)
        self.view = replace(self.defaults, **{name: getattr(file_view, name) for name in words})
        if not self.view.units:
            self._infer_units()
        self._read_entries()
        self._set_estimates()
        with self._naming(""):
            self.entries = contact_point(self.entries)
        self._set_headings()
        if self.entries["M"].value == 4:
            self._set_plane_across()
        self.texts, self.omitted = self._texts()
        self._remark()
        values: dict[str, Any] = dict.fromkeys(ABOUT, "") | self.about | vars(self)
        values |= {"remarks": (*dict.fromkeys(self.remarks),), "estimated": (*self.estimated,)}
        return Case(**{item.name: values[item.name] for item in fields(Case)})

    @contextmanager
    def _naming(self, name: str) -> Iterator[None]:
        """Context in which errors name the place of an entry."""
        try:
            yield
        except UserError as error:
            raise UserError(str(error), self.places.get(name, self.source)) from None

    def _check_names(self) -> None:
        """Raise UserError for a name that is none, and for a source of nothing."""
        for name in (*self.given, *self.sources):
            with self._naming(name):
                if name not in INPUTS:
                    hint = did_you_mean(name, (*INPUTS, *ABOUT))
                    raise UserError(f"{quoted(name)} is not an entry of a scene{hint}")
                if name not in self.given:
                    raise UserError(f"{name}{SOURCE} is given, and {name} is not")

    def _infer_units(self) -> None:
        """Take the system that the units beside the numbers name."""
        units_used: list[tuple[str, str]] = []
        for name, value in self.given.items():
            if any(map(str.isdigit, str(value))) and not str(value).startswith(ESTIMATE):
                with self._naming(name):
                    units_used += units_in(name, value) if isinstance(value, str) else []
        with self._naming(""):
            units = system_using(units_used)
        self.view, self.is_inferred = replace(self.view, units=units), bool(units)

    def _read_entries(self) -> None:
        """Read every entry but the estimates."""
        for name, value in {"M": DEFAULT_M, **self.given}.items():
            if name in ("IA", "IB") and str(value).startswith(ESTIMATE):
                continue
            with self._naming(name):
                amount = self._read(name, value)
            (self.sizes if name in ("LA", "BA", "LB", "BB") else self.entries)[name] = amount

    def _read(self, name: str, value: str | Amount) -> Amount:
        """Return the amount of one entry. Raises UserError."""
        if isinstance(value, Amount):
            return value.mapped(*self.view.map(name))
        if name in ("TA", "TB") and value == COURSE:
            return Amount.exactly(math.nan, COURSE)
        if name in ("MU", "MUP") and value.lower() == LOCKED:
            return Amount.exactly(PIVOT, to_text(PIVOT))
        amount = read(name, value, self.view)
        is_measured = quantity(name).unit in DIMENSIONS and amount.value
        if self.is_inferred and is_measured and not units_in(name, value):
            raise UserError(
                f"{name} = {value} has no unit, and other values have; add one, or "
                f'units = "{self.view.units}" for numbers without (--units {self.view.units})'
            )
        return amount

    def _set_estimates(self) -> None:
        """Set the yaw inertias that are to be estimated."""
        for vehicle, names in SIZES.items():
            name, present = f"I{vehicle}", [n for n in names if n in self.sizes]
            text = str(self.given.get(name, ESTIMATE if present else ""))
            with self._naming(present[0] if present else name):
                if len(present) == 1:
                    raise UserError(f"{present[0]} is given alone; expected {' and '.join(names)}")
                if text.startswith(ESTIMATE):
                    self._set_estimate(name, text, [self.sizes[n].value for n in present])

    def _set_estimate(self, name: str, text: str, sizes: Sequence[float]) -> None:
        """Set a yaw inertia that is estimated, with the tolerance in its text. Raises UserError."""
        mass = self.entries.get(f"M{name[1]}")
        if mass is None:
            raise UserError(f"{name} = {text} needs M{name[1]}")
        value, rule = estimate(name, mass.value, sizes, self.view)
        tolerance = normalize(text).removeprefix(ESTIMATE)
        self.entries[name] = read(name, f"{to_text(value)}{tolerance}", self.view)
        self.estimated.append(name)
        self.remarks.append(f"{name} = {value:g} {self.view.unit(name)} is estimated: {rule}")

    def _set_headings(self) -> None:
        """Set the headings of vehicles that face a course which is known."""
        for name, heading in headings(self.entries).items():
            if name in self.entries and self.entries[name].text == COURSE:
                self.entries[name] = heading

    def _set_plane_across(self) -> None:
        """Set GA and MU of point masses that move along one line."""
        line, is_implied = line_of_motion(self.entries)
        if line is None or "GA" in self.entries:
            return
        friction = next((n for n in ("MU", "MUP") if n in self.entries), None)
        self.entries["GA"] = Amount.exactly(line, to_text(line))
        self.remarks.append(
            "the motion is along one line: the contact plane is across it, and nothing acts along "
            "the plane (MU = 0)"
        )
        if friction and self.entries[friction].value == PIVOT:
            return
        if friction:
            del self.entries[friction]
            self.remarks.append(f"{friction} is not used: nothing slides along the contact plane")
        if friction or not is_implied:
            self.entries["MU"] = Amount.exactly(0.0, "0")

    def _texts(self) -> tuple[dict[str, str], tuple[str, ...]]:
        """Return what is typed into the 1988 program, and the names that are typed though not
        given. Raises UserError."""
        nominal = contact_point({n: replace(a, kind="exact") for n, a in self.entries.items()})
        known = headings(nominal)
        amounts = {n: known.get(n, a) if a.text == COURSE else a for n, a in nominal.items()}
        texts = {n: a.typed for n, a in amounts.items() if not (a.share or math.isnan(a.value))}
        if "MU" in amounts and amounts["MU"].share:
            texts |= self._friction_share(texts)
        is_points = amounts["M"].value == 4 and {*SCENE} - {*OPTIONAL_OF_POINTS} <= {*texts}
        omitted = [name for name in OPTIONAL_OF_POINTS if is_points and name not in texts]
        # line 480 divides by the inertias, of point masses, too
        texts |= {name: "1" if name in ("IA", "IB") else "0" for name in omitted}
        for name in SCENE:
            if len(texts.get(name, "")) > MAX_TYPED:
                with self._naming(name):
                    raise UserError(f"{name} has more than {MAX_TYPED} characters")
        return {name: texts[name] for name in SCENE if name in texts}, tuple(omitted)

    def _friction_share(self, texts: Mapping[str, str]) -> dict[str, str]:
        """Return the MU that is a share of the critical friction of the nominal scene."""
        from ..mechanics.solve import evaluate  # numpy; for a share only

        share = self.entries["MU"].value
        scene = {name: _double(text) for name, text in texts.items()}
        values, missing = evaluate(scene, ["MUC", "gt"])
        turn = -1 if values.get("gt", 0) > 0 else 1  # line 400 turns it again
        critical = turn * float(values.get("MUC", math.nan))
        mu = share * critical
        if not math.isfinite(mu):
            if {"MA", "MB"} <= {*texts}:  # else it is a table's, whose rows have the rest
                names = " ".join(missing.get("MUC", ["a critical friction"]))
                self.remarks.append(f"MU = {self.given['MU']} needs {names} to be a number")
            return {}
        self.remarks.append(
            f"MU = {mu:.6g} is {100 * share:g} % of the critical friction {abs(critical):.6g}"
        )
        return {"MU": to_text(mu)}

    def _remark(self) -> None:
        """Add remarks on how entries were read, and on implausible values."""
        bare = [name for name in ("IA", "IB") if is_number(str(self.given.get(name, "none")))]
        if self.view.units == "us" and bare:
            self.remarks.append(
                f"{' and '.join(bare)} without a unit: read as lb-ft-s2 (slug ft2); for pounds "
                "times feet squared write 'lb ft2', 1/32.17 of it"
            )
        values = {n: a.value for n, a in self.entries.items() if not math.isnan(a.value)}
        sizes = {name: amount.value for name, amount in self.sizes.items()}
        for name, where, words, amount in implausible(values, self.view, courses(values), sizes):
            if where:
                names = ("CAF", "CAL") if name == "DA" else ("CBF", "CBL") if name == "DB" else ()
                entries = [f"{n} = {self.given[n]}" for n in (name, *names) if n in self.given]
                self.remarks.append(words.format(entry=", ".join(entries), amount=amount))


def _double(text: str) -> float:
    """Return the double of a text to type; infinite for the mass of a barrier, which cannot be."""
    return math.inf if text == "INF" else to_double(text)


def _entry(name: str, value: Any) -> str | Amount:
    """Return a value as a case keeps it: a text, "" for nothing, or an amount."""
    if value is None:
        return ""
    if isinstance(value, str):
        return value.strip()
    if isinstance(value, Amount):
        return value
    try:
        return to_text(float(value))
    except (TypeError, ValueError, OverflowError):
        raise UserError(
            f"{name} is {quoted(value)}; expected a number, a text or an Amount"
        ) from None
