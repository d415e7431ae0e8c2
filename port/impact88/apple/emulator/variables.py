"""Strings, variables and arrays in memory.

A descriptor has three bytes, a length and an address: in the program's text, or in the string area,
which grows down from MEMSIZ to FRETOP. A string in the accumulator has the length of a new string
in place of the exponent, its address in two bytes of the mantissa and, in two more, the address of
its descriptor, which alone is used. A variable has two bytes of name and five of value. An array
has two bytes of name, two of length, the number of dimensions, their sizes (the last first, high
byte first) and the elements, first subscript fastest. Addresses of names are cached while none is
moved."""

from collections.abc import Callable, Iterator
from math import prod
from struct import Struct
from typing import NamedTuple

from ..applesoft.errorcodes import ApplesoftError
from ..applesoft.real import ZERO, Number, compare, from_stored, integer, rounded, to_integer
from .faults import Fault, call_at
from .memory import EMPTY, INTEGER, ROM, STRING, TEMPORARIES, TEMPORARIES_END, Memory
from .tokens import CLOSE, COMMA, QUOTE

DESCRIPTOR = 3  # bytes
IS_STRING = 0xFF  # VALTYP of a string
LONGEST = 255  # characters of a string
VARIABLE_SIZE = 7  # bytes
ARRAY_HEADER = 5  # bytes before the sizes
AUTOMATIC = 11  # elements per dimension of an array without DIM
LARGEST_INTEGER = 143  # exponent of the largest number that MKINT accepts
DEEPEST = 63  # below this stack pointer a subscript's formula fails
LOWEST = from_stored("9080000020")
"""The only number below -32767.99 that the ROM accepts, slightly less than -32768."""
AFTER_SUBSCRIPT = (COMMA, CLOSE)
_STORED = Struct(">BI")
stored_at, store = _STORED.unpack_from, _STORED.pack_into


def descriptor(string: Number) -> int:
    """Return the address of the descriptor of a string in the accumulator."""
    mantissa = string[1]
    return mantissa >> 16 & 0xFF | mantissa & 0xFF00


class Array(NamedTuple):
    """An array: ``first``, offset of its elements from ARYTAB; ``sizes``, the last dimension first;
    ``element``, bytes of an element."""

    first: int
    sizes: tuple[int, ...]
    element: int


class Variables(Memory):
    """Strings, variables and arrays."""

    formula: Callable[[int], Number]

    def collect_garbage(self) -> None:
        """GARBAG: move the strings in use together below MEMSIZ, the highest first. At a temporary
        string the ROM stops: it and all below stay."""
        ram = self.ram
        self.fretop = self.memsiz
        places = [*range(TEMPORARIES, self.temppt, DESCRIPTOR)]
        places += [
            place + 2
            for place in range(self.vartab, self.arytab, VARIABLE_SIZE)
            if ram[place] < 0x80 <= ram[place + 1]
        ]
        for array, size in self._array_places():
            if ram[array] < 0x80 <= ram[array + 1]:
                places += range(array + 5 + 2 * ram[array + 4], array + size, DESCRIPTOR)
        strings = [(self.word(place + 1), n, place) for n, place in enumerate(places) if ram[place]]
        for address, _, place in sorted(strings, reverse=True):
            if not self.strend <= address < self.fretop:
                continue
            if place < TEMPORARIES_END:
                return
            length = ram[place]
            self.fretop -= length
            self.move(address, self.fretop, length)
            self.put_word(place + 1, self.fretop)

    def allocate(self, length: int) -> int:
        """GETSPA: return the address of space for characters. Raises OUT OF MEMORY."""
        self.require_room(self.strend + length - 1)
        self.fretop -= length
        return self.fretop

    def move(self, source: int, target: int, length: int) -> None:
        ram = self.ram
        if target < source < target + length:
            for offset in range(length - 1, -1, -1):
                ram[target + offset] = ram[source + offset]
        else:
            ram[target : target + length] = ram[source : source + length]

    def temporary(self, length: int, address: int, extension: int = 0) -> Number:
        """PUTNEW: put a new temporary string in the accumulator. Raises FORMULA TOO COMPLEX."""
        place = self.temppt
        if place == TEMPORARIES_END:
            raise ApplesoftError("FORMULA TOO COMPLEX")
        self.ram[place] = length
        self.put_word(place + 1, address)
        self.lastpt = place
        self.temppt = place + DESCRIPTOR
        self.valtyp = IS_STRING
        mantissa = (address & 0xFF) << 32 | (address >> 8) << 24 | place << 16 | extension
        self.fac = length, mantissa, self.fac[2]
        return self.fac

    def literal(self, address: int, *ends: int) -> Number:
        """STRLIT, STRLT2: return the string from an address to a zero or one of ``ends``, by
        default a quote, and move TXTPTR past it and its quote. Text on page 0 or 2 is copied."""
        ram = self.ram
        end = ram.index(0, address)
        for byte in ends or (QUOTE,):
            place = ram.find(byte, address, end)
            end = place if place >= 0 else end
        length = end - address & 0xFF
        self.charac = 0
        page = address >> 8
        if page in (0, 2):
            copy = self.allocate(length)
            self.move(address, copy, length)
            address = copy
        string = self.temporary(length, address, page)
        self.txtptr = end + (ram[end] == QUOTE)
        return string

    def new_string(self, text: bytes, extension: int = 0) -> Number:
        """STRINI and PUTNEW: return a temporary string with these characters."""
        address = self.allocate(len(text))
        self.ram[address : address + len(text)] = text
        return self.temporary(len(text), address, extension)

    def release(self, place: int) -> bool:
        """FRETMS: free a temporary's descriptor. Return False if it is not the latest one."""
        if place != self.lastpt:
            return False
        self.temppt = place
        self.lastpt = place - DESCRIPTOR
        return True

    def free_string(self, place: int) -> tuple[int, int]:
        """FRETMP: return length and address of a string after use; the latest temporary is freed,
        with its characters if they are the lowest."""
        was_latest = self.release(place)
        length, address = self.ram[place], self.word(place + 1)
        if was_latest and address == self.fretop:
            self.fretop += length
        return length, address

    def release_text(self, place: int) -> bytes:
        """FRETMP: free a string after use, by its descriptor, and return its characters."""
        length, address = self.free_string(place)
        return bytes(self.ram[address : address + length])

    def assign_string(self, target: int, string: Number) -> None:
        """PUTSTR: assign the string in the accumulator to a variable, copied from another one's."""
        ram = self.ram
        place = descriptor(string)
        if self.word(place + 1) >= self.fretop and place >= self.vartab:
            length = ram[place]
            address = self.allocate(length)
            self.move(self.word(place + 1), address, length)
        else:
            self.release(place)
            length, address = ram[place], self.word(place + 1)
        if target < ROM:
            ram[target] = length
            self.put_word(target + 1, address)

    def concatenate(self, left: int, right: int) -> Number:
        """CAT: return left + right, by their descriptors. Raises STRING TOO LONG past 255."""
        ram = self.ram
        size = ram[left]
        length = size + ram[right]
        if length > LONGEST:
            raise ApplesoftError("STRING TOO LONG")
        address = self.allocate(length)
        self.move(self.word(left + 1), address, size)
        suffix, source = self.free_string(right)
        self.move(source, address + size, suffix)
        self.free_string(left)
        return self.temporary(length, address, left >> 8)

    def variables_changed(self) -> None:
        ram = self.ram
        self.simple: dict[int, int] = {}
        for place in range(self.vartab, self.arytab - VARIABLE_SIZE + 1, VARIABLE_SIZE):
            self.simple.setdefault(ram[place] << 8 | ram[place + 1], place + 2)
        self.arrays: dict[int, Array] = {}
        for place, size in self._array_places():
            ends = range(place + 5, place + size - 1, 2)[: ram[place + 4]]
            sizes = tuple(ram[at] << 8 | ram[at + 1] for at in ends)
            name = ram[place] << 8 | ram[place + 1]
            self.arrays.setdefault(name, self._array(name, place, sizes))

    def _array_places(self) -> Iterator[tuple[int, int]]:
        place = self.arytab
        while place < self.strend and (size := self.word(place + 2)):
            yield place, size
            place += size

    def _array(self, name: int, place: int, sizes: tuple[int, ...]) -> Array:
        element = 5 - (name >> 15) - 2 * (name >> 7 & 1)  # a real 5, a string 3, an integer 2
        first = place - self.arytab + ARRAY_HEADER + 2 * len(sizes)
        return Array(first, sizes, element)

    def require_room(self, address: int) -> None:
        """REASON: make sure that memory is free up to an address. Raises OUT OF MEMORY."""
        if address >= self.fretop:
            self.collect_garbage()
            if address >= self.fretop:
                raise ApplesoftError("OUT OF MEMORY")

    def variable(self, sp: int, dimensions: int = 0, mark: int = 0, make: bool = True) -> int:
        """PTRGET: read a variable's name and return the address of its value, created if necessary.
        ``dimensions``: nonzero for DIM, whose arrays must be new; ``mark``: the top bit for FN;
        ``make``: False in a formula, where a simple variable never assigned is a zero in ROM."""
        name, self.txtptr, subscripts = self.names.get(self.txtptr) or self.name_at(sp)
        self.valtyp = IS_STRING if name & INTEGER == STRING else 0
        self.inttyp = name & INTEGER == INTEGER
        if self.inttyp and self.subflg:
            raise Fault("SYNTAX", sp)
        if subscripts and not self.subflg:
            return self.array_element(name, sp, dimensions)
        self.subflg = 0
        name |= mark
        address = self.simple.get(name)
        if address is None:
            if not make:
                return EMPTY
            address = call_at(sp - 4, self._make, name)
        self.varpnt = address
        return address

    def _make(self, name: int) -> int:
        """MAKE NEW VARIABLE: create it, zero or empty, and move the arrays up. Raises OUT OF
        MEMORY."""
        ram = self.ram
        self.require_room(self.strend + VARIABLE_SIZE)
        place = self.arytab
        ram[place + VARIABLE_SIZE : self.strend + VARIABLE_SIZE] = ram[place : self.strend]
        self.arytab += VARIABLE_SIZE
        self.strend += VARIABLE_SIZE
        ram[place : place + VARIABLE_SIZE] = bytes((name >> 8, name & 0xFF, 0, 0, 0, 0, 0))
        self.simple[name] = place + 2
        return place + 2

    def array_element(self, name: int, sp: int, dimensions: int = 0) -> int:
        """ARRAY: return the address of an element; the array is created if necessary."""
        kind = self.valtyp, self.inttyp
        subscripts: list[int] = []
        depth = sp - 7
        ram = self.ram
        while True:
            atom = self.atoms.get(self.txtptr + 1)
            if atom and ram[atom[0]] in AFTER_SUBSCRIPT and depth >= DEEPEST:
                self.txtptr, simple, constant = atom
                e, m, s = self.fac = constant or self.value(self.simple.get(simple, EMPTY))
            else:
                self.txtptr += 1
                e, m, s = self.formula(depth - 4)
                if self.valtyp:
                    raise Fault("TYPE MISMATCH", depth - 2)
            if s or e > LARGEST_INTEGER:
                raise Fault("ILLEGAL QUANTITY", depth)
            subscripts.append(m >> 168 - e)
            byte = ram[self.txtptr]
            if byte != COMMA and self.character() != COMMA:
                break
            depth -= 2
        if byte == CLOSE:
            self.txtptr += 1
        else:
            self.expect(CLOSE, depth + 1)
        self.valtyp, self.inttyp = kind
        n = len(subscripts)
        bottom = sp - 2 * n
        array = self.arrays.get(name)
        if array is None:
            array = call_at(bottom - 2, self._make_array, name, subscripts, dimensions)
            if dimensions:
                return 0
        elif dimensions:
            raise Fault("REDIM'D ARRAY", bottom)
        first, sizes, element = array
        if len(sizes) != n:
            raise Fault("BAD SUBSCRIPT", bottom)
        index = 0
        for size in sizes:
            n -= 1
            subscript = subscripts[n]
            if subscript >= size:
                raise Fault("BAD SUBSCRIPT", sp - 2 * n)
            index = index * size + subscript
        self.varpnt = self.arytab + first + element * index
        return self.varpnt

    def _make_array(self, name: int, last: list[int], dimensions: int) -> Array:
        ram, place = self.ram, self.strend
        start = place + ARRAY_HEADER + 2 * len(last)
        self.require_room(start)
        sizes = tuple(n + 1 for n in reversed(last)) if dimensions else (AUTOMATIC,) * len(last)
        header = bytes((name >> 8, name & 0xFF, 0, 0, len(last)))
        header += b"".join(size.to_bytes(2, "big") for size in sizes)
        ram[place:start] = header
        array = self._array(name, place, sizes)
        end = start + array.element * prod(sizes)
        if end > 0xFFFF:
            raise ApplesoftError("OUT OF MEMORY")
        self.require_room(end)
        ram[start:end] = bytes(end - start)
        self.put_word(place + 2, end - place)
        self.strend = end
        self.arrays[name] = array
        return array

    def value(self, address: int) -> Number:
        """MOVFM: return the real at an address."""
        e, m = stored_at(self.ram, address)
        return (e, (m | 0x80000000) << 8, m >> 31) if e else ZERO

    def integer_value(self, address: int) -> Number:
        n = self.ram[address] << 8 | self.ram[address + 1]
        return integer(n - (n >> 15 << 16))

    def assign(self, address: int, x: Number) -> None:
        """SETFOR: assign a number, rounded, to a real variable; it stays in the accumulator."""
        e, m, s = self.fac = rounded(x) if x[1] & 0xFF else x
        if address < ROM:
            store(self.ram, address, e, m >> 8 & 0x7FFFFFFF | s << 31)

    def assign_integer(self, address: int, x: Number, sp: int) -> None:
        """AYINT: assign a number, rounded, to an integer variable. Raises ILLEGAL QUANTITY from
        32768 and -32768 on; a wrong bit in the ROM's constant admits -32768.0005, as 32767."""
        x = call_at(sp, rounded, x)
        if x[0] >= 0x90 and compare(LOWEST, x):
            raise Fault("ILLEGAL QUANTITY", sp)
        if address < ROM:
            self.ram[address : address + 2] = (to_integer(x) & 0xFFFF).to_bytes(2, "big")
