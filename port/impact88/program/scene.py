"""A scene: the listing's 21 values as the text that was typed, and the files that hold them.

The digits typed are part of the evidence (90315.8817 and 90315.88170 differ in their last bit), so
a scene keeps text; an arithmetic reads it later. The file form is TOML, flat, keyed by the
listing's names; only the raw text of a value is used, never TOML's own idea of the number.
"""

from __future__ import annotations

import math
import re
from collections.abc import Hashable, Iterator, Mapping

from ..collision.case import Case, check_mapping, check_value, is_share
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
M_LINE = 350
"""The line of the listing that sets M."""
TYPED_LIMIT = 239
"""Characters that the Apple takes in a line."""
LISTING = "impact.bas"


class Scene(Mapping[str, str]):
    """The 21 values of a scene by the listing's names, in the table's order, each as typed.

    Parameters
    ----------
    values : mapping of str to str
        Texts by name as a file may have them: numbers, amounts with units, limits (whose middle is
        taken), a share of the critical friction, estimates; M is 6 where it is missing.
    title, source : str, optional
        What the scene is called, and what messages call it.
    units : str, optional
        The system of bare numbers, where no entry names one. The scene's texts are in its base
        units.

    Attributes
    ----------
    case : Case
        All that was said of the scene, as it was written.

    Raises
    ------
    UserError
        For a missing or unknown name, and for text that is no amount.

    Examples
    --------
    >>> scene = impact88.sample(1).replaced({"MU": ".5"})
    >>> scene["MU"], scene.numbers()["E"]
    ('.5', 0.005)
    """

    __slots__ = ("_values", "case", "remarks")

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
    def of(cls, case: Case) -> Self:
        """Return the scene of a case. Raises UserError."""
        scene = cls.__new__(cls)
        scene._take(case)
        return scene

    def _take(self, case: Case) -> None:
        single, source = case.at_nominal(), case.source
        given = dict(single.values)
        check_names(given, SCENE, "value of a scene", source)
        absent = [name for name in SCENE if name not in given]
        if absent:
            raise UserError(missing(absent), source)
        self.remarks = dict(single.remarks)
        if is_share(given["MU"]):
            from ..mechanics.closedform.share import resolved  # needed for a share only

            checked = {
                n: check_value(n, text, case.place(n)) for n, text in given.items() if n != "MU"
            }
            given["MU"], self.remarks["MU"] = resolved({**checked, "MU": given["MU"]}, source)
        self._values = {name: check_value(name, given[name], case.place(name)) for name in SCENE}
        self.case = case

    @classmethod
    def from_mapping(
        cls, values: Mapping[str, str], source: str = "scene", units: str | None = None
    ) -> Self:
        """Return the scene of texts by name. Raises UserError."""
        return cls.of(Case(values, source, units))

    @classmethod
    def from_toml(cls, path: str, units: str | None = None) -> Self:
        """Return the scene in a TOML file. Raises UserError naming file, line or key."""
        return cls.of(case_in(path, units))

    @classmethod
    def from_toml_text(cls, text: str, source: str, units: str | None = None) -> Self:
        """Return the scene in a TOML document; ``source`` names it in errors."""
        if not isinstance(text, str):
            raise UserError(f"{quoted(text)} is not the text of a file")
        return cls.of(Case(toml_texts(text, source), source, units))

    @property
    def title(self) -> str | None:
        """The title that the case has."""
        return self.case.title

    @property
    def source(self) -> str:
        """What messages call the scene."""
        return self.case.source

    @property
    def units(self) -> str | None:
        """The system of units the case was written in; the values are in its base units."""
        return self.case.units

    @property
    def estimated(self) -> dict[str, str]:
        """How each value that is an estimate was found."""
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
        """The scene file, as a notebook shows it."""
        return notebook.preformatted(self.to_toml())

    def replaced(self, changes: Mapping[str, str]) -> Self:
        """Return this scene with some values changed, as `Case.replaced` does; a share of the
        critical friction stays that share. Raises UserError."""
        check_mapping(changes)
        return type(self).of(self.case.replaced(changes))

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
        """Return the scene as a commented TOML file, as it was written."""
        return template(self.case)


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
        Its 21 values in ft, slug and s, each as the listing or the printout has it.

    Raises
    ------
    UserError
        For another number.

    Examples
    --------
    >>> impact88.sample(2)["M"]
    '4'
    """
    if not isinstance(number, Hashable) or number not in _SAMPLES:
        raise UserError(f"there is no sample {number}; expected {', '.join(map(str, SAMPLES))}")
    title, typed = _SAMPLES[number]
    values = published_data() | dict(entry.split("=") for entry in typed.split())
    # the chapter's values are in ft, slug and s
    return Scene({**values, "units": "chapter"}, title, f"sample {number}")
