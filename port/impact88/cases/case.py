"""A case: what a file, a form or a mapping says of one collision, as immutable amounts.

Every command reads its values from a case. It keeps the text of each entry as written, and
`Case.with_` returns the case of the edited file: ``COMMAND FILE --set K=V`` gives what editing that
line of FILE gives."""

from __future__ import annotations

import math
from collections.abc import Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from ..decimals import to_double, to_text
from ..errors import UserError, quoted
from ..files import decode, display_name, read_bytes
from ..names import (
    ANGLE,
    DEFAULT_M,
    NUMBER,
    PERCENT,
    PIVOT,
    SCENE,
    SPIN,
    TIME,
    did_you_mean,
    quantity,
)
from .amounts import TOLERANCE, Amount, normalized, read, units_in
from .estimates import estimate
from .motion import contact_point, courses, headings, line_of_motion
from .plausibility import implausible
from .scenefile import ABOUT, INPUTS, MAX_BYTES, SOURCE, read_toml, write_toml
from .units import PLAIN, View, system_using

if TYPE_CHECKING:
    from collections.abc import Iterator

ESTIMATE = "estimate"
COURSE = "course"
LOCKED = "locked"
OPTIONAL_OF_POINTS = "DA DB PA PB TA TB IA IB EM GA E MU WA WB".split()
"""Inputs that a scene of point masses need not have."""
SIZES = {"A": ("LA", "BA"), "B": ("LB", "BB")}
"""Length and width of each vehicle: for an estimate of its inertia, and its outline in drawings."""
MAX_TYPED = 70  # characters of a value; three and their commas fit the 239 that INPUT keeps
_UNITLESS = (NUMBER, PERCENT, ANGLE, SPIN, TIME)
"""Rules whose bare numbers mean the same in each system."""


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

    @classmethod
    def load(
        cls,
        path: str,
        *,
        units: str | None = None,
        axes: str | None = None,
        headings: str | None = None,
    ) -> Case:
        """Return the case in a TOML file.

        Parameters
        ----------
        path : str
            The file, ``-`` for standard input.
        units, axes, headings : str, optional
            The view of a file that names none.

        Raises
        ------
        UserError
            For a file that cannot be read as a case; the message names file, line and entry.
        """
        source = display_name(path)
        text = decode(read_bytes(path, MAX_BYTES), source)
        return cls.loads(text, source, units=units, axes=axes, headings=headings)

    @classmethod
    def loads(
        cls,
        text: str,
        source: str = "scene",
        *,
        units: str | None = None,
        axes: str | None = None,
        headings: str | None = None,
    ) -> Case:
        """Return the case in the text of a TOML file.

        Parameters
        ----------
        text : str
            The document.
        source : str, default "scene"
            Its name in messages.
        units, axes, headings : str, optional
            The view of a document that names none.

        Raises
        ------
        UserError
            See `load`.
        """
        texts, lines = read_toml(text, source)
        places = {name: f"{source}, line {number}" for name, number in lines.items()}
        view = View.of(units=units, axes=axes, headings=headings)
        return cls.of(texts, source, view, places)

    @classmethod
    def of(
        cls,
        entries: Mapping[str, Any],
        source: str = "scene",
        view: View = PLAIN,
        places: Mapping[str, str] | None = None,
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

        Raises
        ------
        UserError
            For an unknown name, a text that is not an amount, units of two systems, a bare number
            among units, and entries that contradict one another.
        """
        return _Reader(entries, source, view, places or {}).case()

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
            text = normalized(value) if isinstance(value, str) else value
            if isinstance(text, str) and text.startswith(TOLERANCE):
                text = f"{self._middle(name, text)} {text}"
            texts[name] = text
            if name + SOURCE not in changes:
                texts.pop(name + SOURCE, None)
        places = {**self.places, **dict.fromkeys(changes, where)} if where else self.places
        return Case.of(texts, self.source, self.defaults, places)

    def _middle(self, name: str, tolerance: str) -> str:
        """Return the present value of an entry as text, to put a tolerance around."""
        text = self.written.get(name, "0" if name in ("CX", "CY") else "")
        amount = self.entries.get(name)
        if isinstance(text, str) and text and not (amount and amount.varies):
            if text.startswith(ESTIMATE) or not text[-1:].isdigit():
                return text
            has_unit = any(c.isalpha() for c in tolerance)
            return f"{text} {self.view.unit(name)}" if has_unit else text
        if amount is None:
            raise UserError(f"{name} = {tolerance}: {name} has no value to put it around")
        if isinstance(text, str) and text.startswith(ESTIMATE):
            return ESTIMATE
        return f"{self.view.shown_text(name, amount.value)} {self.view.unit(name)}".rstrip()

    @property
    def numbers(self) -> dict[str, float]:
        """The scene's nominal values in base units, for `mechanics.solve`."""
        return {
            name: to_double(text) for name, text in self.texts.items() if name not in self.omitted
        }

    @property
    def ranges(self) -> tuple[str, ...]:
        """Names of the values known within limits."""
        return tuple(name for name, amount in self.entries.items() if amount.varies)

    @property
    def of_points(self) -> bool:
        """True for point masses, M = 4."""
        return self.entries["M"].value == 4

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
        texts = {n: self._written_text(n, v) for n, v in self.written.items()}
        names = [n for n in SCENE if n in texts]
        return write_toml({**self.view.words(), **texts}, names, view=self.view)

    def _written_text(self, name: str, value: str | Amount) -> str:
        """Return an entry as text; an amount in its notation."""
        if isinstance(value, str):
            return value
        numbers = [to_text(x) for x in (value.low, value.value, value.high)]
        low, middle, high = numbers
        return {
            "exact": middle,
            "uniform": f"{low} .. {high}",
            "triangular": f"triangular {low} {middle} {high}",
            "normal": f"normal {middle} {to_text(value.sd)}",
        }[value.kind]


class _Reader:
    """The reading of a case's entries."""

    def __init__(
        self, entries: Mapping[str, Any], source: str, view: View, places: Mapping[str, str]
    ) -> None:
        if not isinstance(entries, Mapping) or not all(isinstance(n, str) for n in entries):
            raise UserError(f"{quoted(entries)}: expected a mapping of names to values")
        self.source, self.places, self.defaults = source, places, view
        self.written = {n: v for n, value in entries.items() if (v := _entry(n, value)) != ""}
        self.about = {n: str(self.written[n]) for n in ABOUT if n in self.written}
        self.sources = {
            name.removesuffix(SOURCE): str(text)
            for name, text in self.written.items()
            if name.endswith(SOURCE)
        }
        self.given = {
            name: value
            for name, value in self.written.items()
            if name not in ABOUT and not name.endswith(SOURCE)
        }
        self.entries: dict[str, Amount] = {}
        self.sizes: dict[str, Amount] = {}
        self.estimated: list[str] = []
        self.remarks: list[str] = []

    def case(self) -> Case:
        """Return the case."""
        self._check_names()
        words = {n: self.about.get(n) for n in ("units", "axes", "headings")}
        named = View.of(self.source, **words)
        self.view = View(*(getattr(named, n) or getattr(self.defaults, n) for n in words))
        if not self.view.units:
            self._infer_units()
        self._read_entries()
        self._set_estimates()
        with self._naming(self.source):
            self.entries = contact_point(self.entries)
        self._set_headings()
        if self.entries["M"].value == 4:
            self._set_plane_across()
        texts, omitted = self._texts()
        self._remark()
        about = {n: self.about.get(n, "") for n in ("title", "case", "examiner", "date")}
        return Case(
            MappingProxyType(self.entries),
            self.view,
            MappingProxyType(texts),
            tuple(dict.fromkeys(self.remarks)),
            **about,
            written=MappingProxyType(self.written),
            source=self.source,
            sources=MappingProxyType(self.sources),
            sizes=MappingProxyType(self.sizes),
            estimated=tuple(self.estimated),
            omitted=omitted,
            places=self.places,
            defaults=self.defaults,
        )

    @contextmanager
    def _naming(self, place: str) -> Iterator[None]:
        """Context in which errors name a place."""
        try:
            yield
        except UserError as error:
            raise UserError(str(error), place) from None

    def _place(self, name: str) -> str:
        return self.places.get(name, self.source)

    def _check_names(self) -> None:
        """Raise UserError for a name that is none, and for a source of nothing."""
        for name in (*self.given, *self.sources):
            if name not in INPUTS:
                hint = did_you_mean(name, (*INPUTS, *ABOUT)) or "; expected a name of the listing"
                raise UserError(
                    f"{quoted(name)} is not an entry of a scene{hint}", self._place(name)
                )
        for name in self.sources:
            if name not in self.given:
                raise UserError(f"{name}{SOURCE} is given, and {name} is not", self._place(name))

    def _infer_units(self) -> None:
        """Take the system that the units beside the numbers name; bare numbers are refused then."""
        used, bare = [], []
        for name, value in self.given.items():
            if not isinstance(value, str) or not any(map(str.isdigit, value)) or name == "M":
                continue
            with self._naming(self._place(name)):
                units = (
                    units_in(name, value.removeprefix(ESTIMATE) or "0")
                    if (not value.startswith(ESTIMATE))
                    else []
                )
            used += units
            if not units and not value.startswith(ESTIMATE):
                bare.append(name)
        with self._naming(self.source):
            units_name = system_using(used)
        if not units_name:
            return
        for name in bare:
            if quantity(name).unit not in _UNITLESS and read(name, str(self.given[name])).value:
                raise UserError(
                    f"{name} = {self.given[name]} has no unit, and other values have; add one, or "
                    f'units = "{units_name}" for numbers without (--units {units_name})',
                    self._place(name),
                )
        self.view = View(units_name, self.view.axes, self.view.headings)

    def _read_entries(self) -> None:
        """Read every entry but the estimates."""
        for name, value in {"M": DEFAULT_M, **self.given}.items():
            with self._naming(self._place(name)):
                amount = self._read(name, value)
            if amount is not None:
                (self.sizes if name in ("LA", "BA", "LB", "BB") else self.entries)[name] = amount

    def _read(self, name: str, value: str | Amount) -> Amount | None:
        """Return the amount of one entry; None for an estimate."""
        if isinstance(value, Amount):
            return value.mapped(*self.view.map(name))
        word = value.strip().lower()
        if name in ("IA", "IB") and word.startswith(ESTIMATE):
            return None
        if name in ("TA", "TB") and word == COURSE:
            return Amount.exactly(math.nan, COURSE)
        if name in ("MU", "MUP") and word == LOCKED:
            return Amount.exactly(PIVOT, to_text(PIVOT))
        return read(name, value, self.view)

    def _set_estimates(self) -> None:
        """Set the yaw inertias that are to be estimated."""
        for vehicle, names in SIZES.items():
            name, present = f"I{vehicle}", [n for n in names if n in self.sizes]
            if len(present) == 1:
                message = f"{present[0]} is given alone; expected {names[0]} and {names[1]}"
                raise UserError(message, self._place(present[0]))
            text = str(self.given.get(name, ESTIMATE if present else ""))
            if not text.startswith(ESTIMATE):
                continue
            sizes = [self.sizes[n].value for n in present]
            with self._naming(self._place(name)):
                if f"M{vehicle}" not in self.entries:
                    raise UserError(f"{name} = {text} needs M{vehicle}")
                mass = self.entries[f"M{vehicle}"].value
                value, rule = estimate(
                    name, mass, (sizes[0], sizes[1]) if sizes else None, self.view
                )
                tolerance = normalized(text).removeprefix(ESTIMATE)
                amount = read(name, f"{to_text(value)}{tolerance}")
            self.entries[name] = amount
            self.estimated.append(name)
            shown = f"{self.view.shown(name, value):.4g} {self.view.unit(name)}".rstrip()
            self.remarks.append(f"{name} = {shown} is estimated: {rule}")

    def _set_headings(self) -> None:
        """Set the headings of vehicles that face a course which is known."""
        following = {
            n for n in ("TA", "TB") if n in self.entries and self.entries[n].text == COURSE
        }
        known = headings(self.entries)
        self.entries |= {name: known[name] for name in following if name in known}

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
        given."""
        nominal = {n: Amount.exactly(a.value, a.text) for n, a in self.entries.items()}
        nominal = {**contact_point(nominal)}
        known = headings(nominal)
        texts = {}
        for name in SCENE:
            amount = nominal.get(name)
            if amount and amount.text == COURSE:
                amount = known.get(name)
            if amount and not (name == "MU" and self.entries["MU"].share):
                texts[name] = amount.typed
        if "MU" in self.entries and self.entries["MU"].share:
            texts |= self._friction_share(texts)
        omitted: tuple[str, ...] = ()
        if self.entries["M"].value == 4 and {"MA", "MB", "UX", "UY", "VX", "VY"} <= {*texts}:
            omitted = tuple(name for name in OPTIONAL_OF_POINTS if name not in texts)
        # line 480 divides by the inertias, of point masses, too
        texts |= {name: "1" if name in ("IA", "IB") else "0" for name in omitted}
        for name, text in texts.items():
            if len(text) > MAX_TYPED:
                message = f"{name} has more than {MAX_TYPED} characters; expected fewer digits"
                raise UserError(message, self._place(name))
        return {name: texts[name] for name in SCENE if name in texts}, omitted

    def _friction_share(self, texts: Mapping[str, str]) -> dict[str, str]:
        """Return the MU that is a share of the critical friction of the nominal scene."""
        from ..mechanics.solve import evaluate  # numpy; for a share only

        share = self.entries["MU"].value
        scene = {name: float(text) for name, text in texts.items()}
        values, missing = evaluate(scene, ["MUC"])
        if missing:
            names = " ".join(missing["MUC"])
            self.remarks.append(f"MU = {self.given['MU']} needs {names}: it is not computed")
            return {}
        critical = float(values["MUC"])
        mu = share * abs(critical)
        if not math.isfinite(mu):
            self.remarks.append(f"MU = {self.given['MU']}: there is no critical friction")
            return {}
        self.remarks.append(
            f"MU = {mu:.6g} is {100 * share:g} % of the critical friction {abs(critical):.6g}"
        )
        return {"MU": to_text(mu)}

    def _remark(self) -> None:
        """Add remarks on how entries were read, and on implausible values."""
        bare = [
            name
            for name in ("IA", "IB")
            if str(self.given.get(name, "")).strip()[-1:].isdigit()
            and name not in self.estimated
            and not any(c.isalpha() for c in str(self.given[name]))
        ]
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


def load(path: str, **options: str | None) -> Case:
    """Return the case in a TOML file, see `Case.load`."""
    return Case.load(path, **options)
