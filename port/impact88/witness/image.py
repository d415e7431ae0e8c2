"""A ROM image: the file the user brings, and whether it is the one the captures were taken from."""

import hashlib
from typing import NamedTuple

from ..errors import UserError
from ..files import read_bytes

START = 0xD000
SIZE = 0x10000 - START
APPLE_II_PLUS = "33a24f5489ba9195b44be77d9afb2252594cb5c7"
"""SHA-1 of the Apple II Plus set: Applesoft in ROM and the autostart monitor."""

_OTHER_SIZES = {
    2048: "one chip of the six that make the set; join $D000 to $F800 in order",
    16384: "an Apple IIe's or IIc's, which begins at $C000",
    20480: "an Apple II Plus set with 8,192 bytes in front that no Apple has there",
    32768: "an Apple IIc's",
}


class Image(NamedTuple):
    """A ROM image: its bytes from $D000 on, their SHA-1, and whether that is the known one."""

    data: bytes
    sha1: str
    known: bool


def read_image(path: str, any_rom: bool = False) -> Image:
    """The image in a file. ``any_rom``: take one that is not known, too.

    Raises UserError for a file that cannot be read, of another size, or not known.
    """
    data = read_bytes(path, limit=1_000_000)
    if len(data) != SIZE:
        hint = _OTHER_SIZES.get(len(data))
        raise UserError(
            f"has {len(data):,} bytes{f' ({hint})' if hint else ''}; expected an Apple II Plus ROM "
            f"of {SIZE:,} bytes, ${START:X} to $FFFF",
            path,
        )
    sha1 = hashlib.sha1(data).hexdigest()
    known = sha1 == APPLE_II_PLUS
    if not known and not any_rom:
        raise UserError(
            f"SHA-1 {sha1} is not the Apple II Plus set's, {APPLE_II_PLUS}; "
            "--any-rom tries it all the same",
            path,
        )
    return Image(data, sha1, known)
