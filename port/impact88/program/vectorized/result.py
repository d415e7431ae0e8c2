"""The results of a replay."""

from collections.abc import Mapping, Sequence

import numpy as np

from ...apple.applesoft.errorcodes import CODES, ApplesoftError
from ...collision.fields import ANGLES, FIELDS, FINAL_SPINS
from ...mechanics import native
from . import compiled, statements
from .blockerrors import BlockErrors, Bools, Ints
from .realcolumns import Scenes
from .reals import Floats, Packed, Reals, from_floats
from .statements import ZERO_DETERMINANT
from .textcolumns import MAX_TEXTS, TEXT, Strings, write

OTHER_M = 2  # the code of a scene whose M is neither 4 nor 6, which is not replayed
NEITHER = "M IS NEITHER 4 NOR 6"
_KINDS = {code: kind for kind, code in CODES.items()}


class Replay:
    """The results of `replay`, a value for each scene; names as in `impact88.names`.

    A scene that ended with an error keeps the values computed before, as on the machine. Later ones
    are NaN as floats, 0 as stored reals and "" as printed fields (see `present`).

    Parameters
    ----------
    scenes : Scenes
        The scenes that were replayed.
    six : ndarray of bool
        True where M is 6.
    errors : BlockErrors
        The records of the scenes' errors.
    values : dict of str to ndarray
        The stored reals by name.

    Attributes
    ----------
    count : int
        The number of scenes.
    code : ndarray of int
        0 without an error, the Applesoft error's code (53, 69, 133), 1 for ZERO DETERMINANT, 2 for
        an M that is neither 4 nor 6 (not replayed).
    line : ndarray of int
        The line of the listing at which the scene ended early (1160 for ZERO DETERMINANT), else 0.

    Examples
    --------
    >>> results = impact88.replay({**impact88.sample(1), "MU": [".5", ".911"]})
    >>> results.printed("LOSS").tolist()
    ['44.43', '57.47']
    """

    def __init__(
        self, scenes: Scenes, six: Bools, errors: BlockErrors, values: dict[str, Floats]
    ) -> None:
        self.count = scenes.size
        self.code: Ints = errors.code()
        self.line: Ints = errors.line()
        self._scenes = scenes
        self._six = six
        self._unit = errors
        self._values = values
        self._fields: dict[str, Strings] = {}

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the results."""
        return tuple(self._values)

    @property
    def zero_determinant(self) -> Bools:
        """True for each scene that ends with ZERO DETERMINANT."""
        return np.asarray(self.code == ZERO_DETERMINANT)

    @property
    def error(self) -> Strings:
        """Error message of each scene, "" without an error.

        A message is such as "?DIVISION BY ZERO ERROR IN 480". ZERO DETERMINANT is a normal end.
        """
        messages = np.full(self.count, "", dtype="<U48")
        for i in np.flatnonzero(self.code > ZERO_DETERMINANT).tolist():
            code, line = int(self.code[i]), int(self.line[i])
            is_other_m = code == OTHER_M
            messages[i] = NEITHER if is_other_m else ApplesoftError(_KINDS[code], line).message
        return messages

    def __len__(self) -> int:
        return self.count

    def __repr__(self) -> str:
        ended = int(np.count_nonzero(self.code > ZERO_DETERMINANT))
        zero = int(np.count_nonzero(self.zero_determinant))
        return (
            f"<Replay of {self.count:,} scenes: {ended:,} ended by an error, {zero:,} by a zero "
            f"determinant; {' '.join(self.names)}>"
        )

    def to_dict(self) -> dict[str, Floats | Strings | Ints]:
        """Return all results as columns of one length, which a DataFrame of any library takes.

        Returns
        -------
        dict of str to ndarray
            Every result as floats, and of each scene ERROR, the message that ended it, and LINE.
        """
        ending = np.where(self.zero_determinant, "ZERO DETERMINANT", self.error)
        results = {name: self.floats(name) for name in self.names}
        return {**results, "ERROR": ending, "LINE": self.line}

    def present(self, name: str) -> Bools:
        """Return a mask of the scenes that have a result.

        Parameters
        ----------
        name : str
            Name of the result.

        Returns
        -------
        ndarray of bool
            True for each scene that has it.
        """
        return self._has_passed(name, statements.ASSIGNED)

    def floats(self, name: str) -> Floats:
        """Return a result as floats, exactly.

        Parameters
        ----------
        name : str
            Name of the result.

        Returns
        -------
        ndarray of float
            The result of each scene, NaN for a scene without it.

        Raises
        ------
        KeyError
            For an unknown name.
        """
        # a stored zero has no sign: 0.0 is added to make every zero the positive one
        return np.where(self.present(name), self._values[name] + 0.0, np.nan)

    def reals(self, name: str) -> Packed:
        """Return a result as the five bytes that the Apple stored.

        Parameters
        ----------
        name : str
            Name of the result.

        Returns
        -------
        ndarray of uint64
            The bytes of each scene as one number, which ``f"{x:010x}"`` writes in hexadecimal, 0
            for a scene without the result.
        """
        packed_reals = from_floats(self._values[name].copy(), None, True).pack()
        return np.where(self.present(name), packed_reals, np.uint64(0))

    def printed(self, name: str) -> Strings:
        """Return a field of the printout, character for character.

        Parameters
        ----------
        name : str
            A result, or a value of the scene. MU and MUP both are the number that line 680 prints;
            KF is not printed.

        Returns
        -------
        ndarray of str
            The field of each scene, such as "-8.78" or "5E-03", "" for a scene that ended before
            it.

        Notes
        -----
        Fields are written when they are first asked for; see `write_fields`.
        """
        name = "MUP" if name == "MU" else name
        self.write_fields([name])
        return self._fields[name]

    def write_fields(self, names: Sequence[str] | None = None) -> None:
        """Write fields now: together they take less time than one by one.

        Parameters
        ----------
        names : sequence of str, optional
            Names of the fields; all by default.
        """
        wanted = FIELDS if names is None else names
        names = [name for name in wanted if name not in self._fields]
        if not names:
            return
        columns = dict(zip(names, self._to_print(names), strict=True))
        varying = [name for name in names if columns[name].size == self.count]
        shared = [name for name in names if name not in varying]
        # one array is paged in twice as fast as many
        texts = np.empty((len(names), self.count), TEXT)
        together = max(1, MAX_TEXTS // max(self.count, 1))
        for at in range(0, len(varying), together):
            group = np.array([columns[name] for name in varying[at : at + together]])
            write(Reals(group, None), texts[at : at + len(group)])
        values = np.array([columns[name] for name in shared]).reshape(-1, 1)
        texts[len(varying) :] = write(Reals(values, None))
        for name, field in zip([*varying, *shared], texts, strict=True):
            is_printed = self._has_passed(name, statements.PRINTED)
            if not is_printed.all():
                field[~is_printed] = ""
            self._fields[name] = field

    def _has_passed(self, name: str, places: Mapping[str, int]) -> Bools:
        """Return True for each scene in which the program got past a name's place."""
        is_past = self._unit.has_passed(places[name]) & (self.code != OTHER_M)
        return np.asarray(is_past & self._six if name in FINAL_SPINS else is_past)

    def _to_print(self, names: list[str]) -> list[Floats]:
        """Return the values that PRINT receives for fields, extension included; of length 1 if all
        scenes share one."""
        values = {**self._scenes.values, **self._values}
        computed_names = [
            name for name in names if name == "LOSS" or name in (*statements.FLOORED, *ANGLES)
        ]
        printed_values = {name: np.empty(self.count) for name in computed_names}
        rows = np.arange(self.count)  # scenes to compute with arrays
        if computed_names and native.library is not None:
            operands = {x: values[x] for name in computed_names for x in compiled.sources(name)}
            varying = frozenset(x for x, v in operands.items() if v.size > 1)
            program = compiled.field_program(tuple(computed_names), varying)
            printed_values, odd = compiled.run_program(program, operands, self.count)
            rows = np.flatnonzero(odd)
        for name in computed_names if rows.size else ():
            columns = [values[x] for x in compiled.sources(name)]
            printed_values[name][rows] = _printed_values(
                name, [v[rows] if v.size > 1 else v for v in columns]
            )
        return [printed_values[name] if name in printed_values else values[name] for name in names]


@np.errstate(all="ignore")
def _printed_values(name: str, columns: list[Floats]) -> Floats:
    """Return the values that PRINT receives for a field, computed with arrays."""
    errors = BlockErrors(columns[0].size)
    return statements.printed_value(name, *(from_floats(v.copy(), errors, True) for v in columns)).v


def field_names() -> tuple[str, ...]:
    """Return the names of the printed fields, in printing order."""
    return tuple(FIELDS)
