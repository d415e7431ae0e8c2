"""A scene: the listing's 21 values as typed, and the files that hold them.

The digits typed matter (90315.8817 and 90315.88170 differ in their last bit), so a scene keeps
text, which an arithmetic reads later. A scene file is flat TOML, keyed by the listing's names;
values keep their raw text, TOML's parsed number is never used."""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Hashable, Iterator, Mapping

from ..collision.case import FACING_COURSE, Case, check_mapping, check_value, share_of
from ..collision.doubles import double
from ..collision.scenefile import case_in, template, toml_texts
from ..errors import UserError, quoted
from ..files import packaged_text
from ..messages import notebook
from ..messages.arguments import explains_arguments
from ..names import DEFAULT_M, SCENE, VELOCITIES, check_names, missing

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Self

DATA_LINES = (280, 290, 310)
"""Lines of the listing that set values."""
REPLY_LINES = (210, 230)
"""Lines of the listing that ask for values."""
M_LINE = 350  # the line of the listing that sets M
INERTIAS = ("IA", "IB")
"""Line 480 divides by them, of point masses, too: 1 is typed where they are not given."""
MAX_LINE_LENGTH = 239  # characters of a line that the Apple keeps
LISTING = "impact.bas"


class Scene(Mapping[str, str]):
    """The 21 values of a scene by the listing's names, in the table's order, each as typed.

    Parameters
    ----------
    values : mapping of str to str
        Texts by name as in a file: numbers, amounts with units, ranges (whose nominal value is
        used), a percentage of the critical friction, estimates. M defaults to 6.
    title, source : str, optional
        The scene's title, and its name in messages.
    units : str, optional
        The system of bare numbers if no entry names one. The scene's texts are in its base units.

    Attributes
    ----------
    case : Case
        The entries of the scene as written.
    omitted : tuple of str
        Names that are not given, for which 0 is typed, of inertias 1; only `Scene.of` allows any.

    Raises
    ------
    UserError
        For a missing or unknown name, or a text that is not an amount.

    Examples
    --------
    >>> scene = impact88.sample(1).replaced({"MU": ".5"})
    >>> scene["MU"], scene.numbers()["E"]
    ('.5', 0.005)
    """

    __slots__ = ("_values", "case", "omitted", "remarks")

    def __init__(
        self,
        values: Mapping[str, str],
        title: str | None = None,
        source: str = "scene",
        units: str | None = None,
    ) -> None:
        check_mapping(values)
        self._take(Case({**values, "title": title} if title else values, source, units))

    @classmethod
    def of(cls, case: Case, may_omit: Collection[str] = ()) -> Self:
        """Return the scene of a case.

        Parameters
        ----------
        case : Case
            The entries of a file, form or mapping.
        may_omit : collection of str, optional
            Names that need not be given: 0 is typed for them, of inertias 1, and ``omitted`` names
            them.

        Returns
        -------
        Scene
            The scene, with ranges at their nominal values.

        Raises
        ------
        UserError
            For a missing or unknown name, or a text that is not an amount.
        """
        scene = cls.__new__(cls)
        scene._take(case, may_omit)
        return scene

    def _take(self, case: Case, may_omit: Collection[str] = ()) -> None:
        """Set the values from the nominal values of ``case``. Raises UserError."""
        nominal_case, source = case.at_nominal(), case.source
        values = dict(nominal_case.values)
        check_names(values, SCENE, "value of a scene", source)
        # a vehicle at rest that faces the way it travels has no heading yet
        absent = [name for name in SCENE if values.get(name, FACING_COURSE) == FACING_COURSE]
        if names := [name for name in absent if name not in may_omit]:
            raise UserError(missing(names), source)
        self.omitted = tuple(absent)
        values |= {name: "1" if name in INERTIAS else "0" for name in absent}
        self.remarks = dict(nominal_case.remarks)
        if (share := share_of(values["MU"])) is not None:
            from ..mechanics.closedform.general import resolve_share  # needed for a share only

            texts = {
                n: check_value(n, text, case.place(n)) for n, text in values.items() if n != "MU"
            }
            values["MU"], self.remarks["MU"] = resolve_share(
                {**texts, "MU": values["MU"]}, share, source
            )
        self._values = {name: check_value(name, values[name], case.place(name)) for name in SCENE}
        self.case = case

    @classmethod
    def from_mapping(
        cls, values: Mapping[str, str], source: str = "scene", units: str | None = None
    ) -> Self:
        """Return the scene of texts by name.

        Parameters
        ----------
        values : mapping of str to str
            Texts by the listing's names, as `Scene` takes them.
        source : str, default "scene"
            The scene's name in messages.
        units : str, optional
            The system of bare numbers if no entry names one.

        Returns
        -------
        Scene
            The scene, with ranges at their nominal values.

        Raises
        ------
        UserError
            For a missing or unknown name, or a text that is not an amount.
        """
        return cls.of(Case(values, source, units))

    @classmethod
    def from_toml(cls, path: str, units: str | None = None) -> Self:
        """Return the scene in a TOML file.

        Parameters
        ----------
        path : str
            Path of the file.
        units : str, optional
            The system of bare numbers if the file names none.

        Returns
        -------
        Scene
            The scene, with ranges at their nominal values.

        Raises
        ------
        UserError
            For a file that cannot be read as a scene; the message names file, line or key.
        """
        return cls.of(case_in(path, units))

    @classmethod
    def from_toml_text(cls, text: str, source: str, units: str | None = None) -> Self:
        """Return the scene in a TOML document.

        Parameters
        ----------
        text : str
            The document.
        source : str
            Its name in messages.
        units : str, optional
            The system of bare numbers if the document names none.

        Returns
        -------
        Scene
            The scene, with ranges at their nominal values.

        Raises
        ------
        UserError
            For a text that cannot be read as a scene; the message names line or key.
        """
        if not isinstance(text, str):
            raise UserError(f"{quoted(text)} is not the text of a file")
        return cls.of(Case(toml_texts(text, source), source, units))

    @property
    def given(self) -> dict[str, str]:
        """The values without those omitted."""
        return {name: text for name, text in self._values.items() if name not in self.omitted}

    @property
    def title(self) -> str | None:
        """The title, None without one."""
        return self.case.title

    @property
    def source(self) -> str:
        """The scene's name in messages."""
        return self.case.source

    @property
    def units(self) -> str | None:
        """The system of units of the entries, None without units; values are in its base units."""
        return self.case.units

    @property
    def estimated(self) -> dict[str, str]:
        """The rule behind each estimated value, in words."""
        return self.case.estimated

    def __getitem__(self, name: str) -> str:
        return self._values[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __repr__(self) -> str:
        return f"Scene({self._values!r})"

    def _repr_html_(self) -> str:
        """Return the scene file as HTML for a notebook."""
        return notebook.preformatted_html(self.to_toml())

    def replaced(self, changes: Mapping[str, str]) -> Self:
        """Return this scene with some values changed.

        Parameters
        ----------
        changes : mapping of str to str
            New texts by name, as an edit of the scene's file: amounts, ranges around the present
            value, estimates, or nothing, which takes an entry out. A percentage of the critical
            friction stays that percentage.

        Returns
        -------
        Scene
            The changed scene.

        Raises
        ------
        UserError
            For an unknown name, or a text that is not an amount.
        """
        check_mapping(changes)
        return type(self).of(self.case.replaced(changes))

    def keyboard(self) -> list[str]:
        """Return the replies to the INPUTs of lines 210 and 230.

        Returns
        -------
        list of str
            Two replies, three numbers each.
        """
        return [",".join(self[n] for n in names) for names in (VELOCITIES[:3], VELOCITIES[3:])]

    def typed_lines(self) -> list[str]:
        """Return the program lines to retype for this scene.

        Returns
        -------
        list of str
            Lines 280, 290 and 310, and 350 unless M is 6.
        """
        lines = [
            f"{line} "
            + ":".join(f"{q.name} = {self[q.name]}" for q in SCENE.values() if q.line == line)
            for line in DATA_LINES
        ]
        if self["M"] != DEFAULT_M:
            lines.append(f"{M_LINE} N = {DEFAULT_M}:M = {self['M']}")
        return lines

    def numbers(self) -> dict[str, float]:
        """Return the values as numbers.

        Returns
        -------
        dict of str to float
            All 21 values by name.

        Raises
        ------
        UserError
            For a value past the range of doubles.
        """
        return numbers_of(self)

    def check_typed(self) -> None:
        """Check that the values can be typed into program lines and mean the same there.

        Raises
        ------
        UserError
            For a value that INPUT and a program line would read differently (in a line ``E`` is the
            variable, and ``-`` alone is not a number), and for a line of more than 239 characters.
        """
        for value in SCENE.values():
            text = self[value.name]
            if value.line not in REPLY_LINES and not re.match(r"[ +-]*[0-9.]", text):
                raise UserError(
                    f"{value.name} = {text!r} is a number to INPUT but not in program line "
                    f"{value.line}; expected one that begins with a digit or a point",
                    self.source,
                )
        for line in self.typed_lines():
            if len(line) > MAX_LINE_LENGTH:
                raise UserError(
                    f"program line {line.split()[0]} has {len(line)} characters with these values; "
                    f"the Apple takes {MAX_LINE_LENGTH}",
                    self.source,
                )

    def to_toml(self) -> str:
        """Return the scene as a commented TOML file.

        Returns
        -------
        str
            The file's text, with the entries as written.
        """
        return template(self.case)


def numbers_of(scene: Mapping[str, object]) -> dict[str, float]:
    """Return a scene's values, texts or numbers, as doubles by name. Raises UserError if one is
    missing or not a finite number."""
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


def published_data() -> dict[str, str]:
    """Return the values in lines 280, 290, 310 and 350 of the published listing."""
    data: dict[str, str] = {}
    for line in packaged_text("impact88.legacy", LISTING).splitlines():
        number, _, statements = line.partition(" ")
        if int(number) in (*DATA_LINES, M_LINE):
            assignments = statements.partition(": REM")[0].split(":")
            data |= dict(statement.split(" = ") for statement in assignments)
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
"""The published runs: title, and the values typed in addition to the listing's data."""

SAMPLES = tuple(_SAMPLES)


@explains_arguments
def sample(number: int) -> Scene:
    """Return the scene of a published run.

    Parameters
    ----------
    number : {1, 2, 3}
        The run.

    Returns
    -------
    Scene
        Its 21 values in ft, slug and s, each as in the listing or the printout.

    Raises
    ------
    UserError
        For any other number.

    Examples
    --------
    >>> impact88.sample(2)["M"]
    '4'
    """
    if not isinstance(number, Hashable) or number not in _SAMPLES:
        raise UserError(f"there is no sample {number}; expected {', '.join(map(str, SAMPLES))}")
    title, entries = _SAMPLES[number]
    values = published_data() | dict(entry.split("=") for entry in entries.split())
    # the chapter's values are in ft, slug and s
    return Scene({**values, "units": "chapter"}, title, f"sample {number}")
