"""Decimal texts to arrays of reals and back, as Applesoft reads numbers and PRINT writes them.

The scalar text of these rules is `impact88.applesoft.decimaltext`. Here all texts of a column are
read together, a character place at a time, and all fields written together.
"""

from collections.abc import Callable, Iterator, Sequence
from functools import partial

import numpy as np
import numpy.typing as npt

from .. import native
from ..applesoft import decimaltext as scalar
from ..errors import UserError
from ..native.program import read_numbers, write_numbers
from .reals import OVERFLOW, ZERO, Reals, compare, constant, from_number, select
from .unit import Bools, Ints, Unit

Characters = npt.NDArray[np.uint8]
Strings = npt.NDArray[np.str_]

_TEN = constant(10)
_HALF = from_number(scalar.HALF)
_BILLION = from_number(scalar.BILLION)
_NINE_DIGITS = from_number(scalar.NINE_DIGITS)
_EIGHT_DIGITS = from_number(scalar.EIGHT_DIGITS)

_EXACT_DIGITS = 9
"""So many digits make a whole number below 2^32, which MUL10 and adding a digit leave exact."""

_END = ord("\n")
AT_A_TIME = 32768
"""So many numbers are written together, by arrays."""

_QUARTER_LIMIT = 2.0**125
"""Four times this is exponent byte 256."""


def times_ten(x: Reals) -> Reals:
    """MUL10: x rounded, as (4x + x) doubled, of which nothing is cut off. Records OVERFLOW."""
    x = x.rounded()
    failed = np.abs(x.v) >= _QUARTER_LIMIT
    if failed.any():
        x.fails(failed, OVERFLOW)
        x = select(failed, ZERO, x)
    return Reals(x.v * 10, x.unit)._settled()


def over_ten(x: Reals) -> Reals:
    """DIV10: |x| rounded, divided by ten."""
    return abs(x) / _TEN


# --- reading --------------------------------------------------------------------------------------


def read(texts: Sequence[str], unit: Unit, where: Callable[[int], str]) -> Reals:
    """The numbers that texts are, extension included: as many texts as ``unit`` has scenes.

    Records OVERFLOW. Raises UserError for a text that is not a number; ``where`` names its place.
    """
    data = _joined(texts, where)
    if native.library is None:
        return _read_together(texts, data, unit, where)
    v, odd = read_numbers(data, len(texts))
    x = Reals(v, unit)
    rows = np.flatnonzero(odd)
    if rows.size:
        some = [texts[row] for row in rows.tolist()]
        again = _joined(some, where)

        def read_again(part: Reals) -> Reals:
            return _read_together(some, again, part._unit(), lambda row: where(int(rows[row])))

        _treat(x, rows, read_again)
    return x


def _read_together(
    texts: Sequence[str], data: bytes, unit: Unit, where: Callable[[int], str]
) -> Reals:
    """`read`, all texts a character place at a time."""
    numerals = _Numerals(len(texts))
    for place in _character_places(data):
        numerals.take(place)
    wrong = numerals.wrong | ~numerals.started
    if wrong.any():
        raise _no_number(texts, int(np.flatnonzero(wrong)[0]), where)
    if numerals.overflow.any():
        unit.fails(numerals.overflow, OVERFLOW)
    v = numerals.value.astype(np.float64)
    x = Reals(v, unit, True)
    for more, digit in numerals.further:
        rows = np.flatnonzero(more)
        _treat(x, rows, partial(_next_digit, digit=digit[rows]))
    exponent = np.where(numerals.exponent_negative, -numerals.exponent, numerals.exponent)
    steps = (exponent - numerals.decimals + 128 & 0xFF) - 128  # in one byte, as `scalar.read`
    for step, count in ((times_ten, steps), (over_ten, -steps)):
        rows = np.flatnonzero(count > 0)
        finished = 0
        while rows.size:
            _treat(x, rows, step)
            finished += 1
            rows = rows[count[rows] > finished]
    np.negative(x.v, out=x.v, where=numerals.negative)
    return x


def _no_number(texts: Sequence[str], row: int, where: Callable[[int], str]) -> UserError:
    return UserError(f"{texts[row]!r} is not a number; expected decimal text", where(row))


def _joined(texts: Sequence[str], where: Callable[[int], str]) -> bytes:
    """The texts, each ended by END. Raises UserError for one that cannot be a number."""
    try:
        data = ("\n".join(texts) + "\n").encode("ascii")
        if data.count(b"\n") == len(texts):
            return data
    except (TypeError, UnicodeEncodeError):
        pass
    wrong = (not isinstance(text, str) or not text.isascii() or "\n" in text for text in texts)
    raise _no_number(texts, next(row for row, is_wrong in enumerate(wrong) if is_wrong), where)


def _character_places(data: bytes) -> Iterator[Characters]:
    """The first character of every text, then the second, ...; an END where a text has no more."""
    characters = np.frombuffer(data, np.uint8)
    ends = np.flatnonzero(characters == _END)
    places = np.empty_like(ends)
    places[0] = 0
    np.add(ends[:-1], 1, out=places[1:])
    for _ in range(int((ends - places).max(initial=0))):
        yield characters[places]
        places += 1
        np.minimum(places, ends, out=places)


class _Numerals:
    """The parts of many numbers' texts, taken in one character place after another.

    Blanks count for nothing. ``value`` holds the first nine digits, ``further`` the others, as
    pairs of which rows and which digit.
    """

    def __init__(self, length: int) -> None:
        self.value = np.zeros(length, np.int64)
        self.digits = np.zeros(length, np.int64)
        self.decimals = np.zeros(length, np.int64)
        self.further: list[tuple[Bools, Characters]] = []
        self.exponent = np.zeros(length, np.int16)
        self.started = np.zeros(length, bool)
        self.negative = np.zeros(length, bool)
        self.point = np.zeros(length, bool)
        self.after_e = np.zeros(length, bool)
        self.sign_may_follow = np.ones(length, bool)
        self.exponent_negative = np.zeros(length, bool)
        self.overflow = np.zeros(length, bool)
        self.wrong = np.zeros(length, bool)

    def take(self, character: Characters) -> None:
        """The next character of every text."""
        digit = character - np.uint8(ord("0"))
        is_digit = digit < 10
        blank = (character == ord(" ")) | (character == _END)
        is_point = character == ord(".")
        exponential = self.after_e.any()
        if exponential:
            of_exponent = is_digit & self.after_e
            if of_exponent.any():
                self._exponent_digit(of_exponent, digit)
            is_mantissa = is_digit & ~self.after_e
            self.wrong |= is_point & self.after_e
        else:
            is_mantissa = is_digit
        room = self.digits < _EXACT_DIGITS
        if not room.all():
            beyond = is_mantissa & ~room
            if beyond.any():
                self.further.append((beyond, digit))
            room &= is_mantissa
        else:
            room = is_mantissa
        np.multiply(self.value, 10, out=self.value, where=room)
        np.add(self.value, digit, out=self.value, where=room)
        self.digits += is_mantissa
        self.decimals += is_mantissa & self.point
        self.wrong |= is_point & self.point
        self.point |= is_point
        known = is_digit | blank | is_point
        if not known.all():
            self._sign_or_e(character, known)
            is_e = (character == ord("E")) | (character == ord("e"))
            self.sign_may_follow = is_e | (self.sign_may_follow & blank)
        else:
            self.sign_may_follow &= blank
        self.started |= ~blank

    def _sign_or_e(self, character: Characters, known: Bools) -> None:
        minus = character == ord("-")
        sign = minus | (character == ord("+"))
        is_e = (character == ord("E")) | (character == ord("e"))
        self.wrong |= sign & ~self.sign_may_follow
        self.negative |= minus & ~self.after_e
        self.exponent_negative |= minus & self.after_e
        self.wrong |= is_e & self.after_e
        self.after_e |= is_e
        self.wrong |= ~(known | sign | is_e)

    def _exponent_digit(self, where: Bools, digit: Characters) -> None:
        """One more digit of the exponent; one too many if those before are worth ten or more."""
        too_many = where & (self.exponent >= 10)
        self.overflow |= too_many & ~self.exponent_negative
        next_exponent = np.where(too_many, 100, self.exponent * 10 + digit)
        np.copyto(self.exponent, next_exponent, where=where, casting="unsafe")


def _next_digit(value: Reals, digit: Characters) -> Reals:
    """Ten times the value, and (ADDACC: that rounded) a digit added."""
    return times_ten(value) + Reals(digit.astype(np.float64), value.unit, True)


def _treat(x: Reals, rows: Ints, operation: Callable[[Reals], Reals]) -> None:
    """Apply an operation to some rows of ``x`` in place, recording its errors with them."""
    assert x.unit is not None
    part = x.unit.part(rows)
    result = operation(Reals(x.v[rows], part))
    x.v[rows] = result.v
    x.stored = False
    x.unit.join(part, rows)


# --- writing --------------------------------------------------------------------------------------


def write(x: Reals) -> Strings:
    """The characters PRINT makes of each: at most nine digits, the extension counted.

    Records OVERFLOW, and writes nothing: where rounding the very largest numbers fails.
    """
    unit = x.unit or Unit(x.v.size)
    if native.library is None:
        texts, rows = np.empty(x.v.shape, f"<U{_WIDTH}"), np.arange(x.v.size)
    else:
        texts, odd = write_numbers(x.v)
        rows = np.flatnonzero(odd)
    for at in range(0, rows.size, AT_A_TIME):
        some = rows[at : at + AT_A_TIME]
        part = unit.part(some)
        texts[some] = _written_together(Reals(x.v[some], part))
        unit.join(part, some)
    return texts


def _written_together(x: Reals) -> Strings:
    """`write`, all numbers a step at a time."""
    number, d, failed = _nine_digits(x)
    texts = _lay_out(number, d, x.v < 0)
    if failed.any():
        x._unit().fails(failed, OVERFLOW)
        texts[failed] = ""
    return texts


_ROUNDS_TO_OVERFLOW = 2.0**127 - 2.0**94
"""From exponent byte 255, mantissa FFFFFFFF and extension 80 on."""
_SURELY_BELOW = 9e7
"""Below this the comparison with 99,999,999.9 needs not be made."""


def _nine_digits(x: Reals) -> tuple[Ints, Ints, Bools]:
    """The nine digits N written for |x|, and d with |x| = N * 10^d; N = 0 for zero. And where |x|
    overflows when DIV10 rounds it, which it does first of all."""
    v = np.abs(x.v)
    failed = v >= _ROUNDS_TO_OVERFLOW
    v[failed] = 0.0
    d = np.zeros(v.shape, np.int64)
    nonzero = v != 0

    def part(rows: Ints) -> Reals:
        return Reals(v[rows], Unit(rows.size))

    rows = np.flatnonzero(nonzero & (v < 1))
    if rows.size:
        v[rows] = (_BILLION * part(rows)).v
        d[rows] = -9
    rounds = nonzero.copy()
    rows = np.flatnonzero(v > _SURELY_BELOW)
    while rows.size:
        current = part(rows)
        order = compare(_NINE_DIGITS, current)
        rounds[rows[order == 0]] = False
        rows = rows[order > 0]
        if rows.size:
            v[rows] = over_ten(part(rows)).v
            d[rows] += 1
    rows = done = np.flatnonzero(rounds)
    while rows.size:
        doubtful = v[rows] > _SURELY_BELOW
        if doubtful.any():
            rows = rows[~doubtful | (compare(_EIGHT_DIGITS, part(rows)) <= 0)]
        if rows.size:
            v[rows] = times_ten(part(rows)).v
            d[rows] -= 1
    if done.size:
        v[done] = (_HALF + part(done)).v
    return np.floor(v).astype(np.int64), d, failed


_WIDTH = 15
"""The longest field: sign, point, nine digits, exponent."""
_ZERO, _POINT, _MINUS, _NOTHING = (np.uint8(ord(c)) for c in "0.-\0")


def _lay_out(number: Ints, d: Ints, negative: Bools) -> Strings:
    """Nine digits times ten to the d, as PRINT sets them (see the scalar `lay_out`).

    The characters are made place by place, all fields at a time: ``out[k]`` holds every field's
    character k.
    """
    length = number.size
    out = np.zeros((_WIDTH, length), np.uint8)
    digits = np.empty((9, length), np.uint8)
    last = np.zeros(length, np.int8)  # the last digit that is not zero
    rest = number.astype(np.uint32)
    for place in range(8, -1, -1):
        tens = rest // np.uint32(10)
        digits[place] = rest - tens * np.uint32(10)
        rest = tens
    for place in range(1, 9):
        last[digits[place] != 0] = place
    digits += _ZERO
    plain = (d >= -10) & (d <= 0)
    point = np.where(plain, d + 9, 1).astype(np.int8)  # so many digits before the point
    end = np.where(last < point, point, last + np.int8(2))
    for place in range(10):
        before = digits[place] if place < 9 else _POINT
        after = digits[place - 1] if place else _POINT
        character = np.where(point > place, before, after)
        character[point == place] = _POINT
        out[place] = np.where(end > place, character, _NOTHING)
    rows = np.flatnonzero(point == -1)
    if rows.size:  # below .1: the point, a zero and the digits
        out[0, rows], out[1, rows] = _POINT, _ZERO
        end[rows] = last[rows] + 3
        for place in range(9):
            out[place + 2, rows] = np.where(last[rows] >= place, digits[place, rows], _NOTHING)
    rows = np.flatnonzero(~plain)
    if rows.size:
        places = end[rows]
        exponent = d[rows] + 8
        size = np.abs(exponent)
        out[places, rows] = ord("E")
        out[places + 1, rows] = np.where(exponent < 0, ord("-"), ord("+"))
        out[places + 2, rows] = ord("0") + size // 10
        out[places + 3, rows] = ord("0") + size % 10
    zero = number == 0
    if zero.any():
        out[:, zero] = 0
        out[0, zero] = _ZERO
        negative = negative & ~zero
    if negative.any():
        for place in range(_WIDTH - 1, 0, -1):
            out[place] = np.where(negative, out[place - 1], out[place])
        out[0, negative] = _MINUS
    return np.ascontiguousarray(out.T).astype(np.uint32).view(f"<U{_WIDTH}").reshape(length)
