"""Every captured call of the ROM's arithmetic, bit for bit, and the codes of its errors."""

from __future__ import annotations

import captures
import pytest

from impact88.apple import captured
from impact88.apple.applesoft.errorcodes import CODES


@pytest.mark.captures
@pytest.mark.parametrize("path", captures.arithmetic_files(), ids=captures.vector_file_id)
def test_every_vector(path):
    count = 0
    wrong = []
    for operation, first, second, extension, result in captures.vectors(path):
        count += 1
        got = captured.call(operation, first, second, extension)
        if got != captured.result(result):
            wrong.append((operation, first, second, extension, result, got))
    assert count
    assert not wrong, f"{len(wrong)} of {count}, first {wrong[0]}"


@pytest.mark.captures
def test_a_changed_digit_is_seen():
    for path in captures.arithmetic_files():
        *call, result = next(
            row for row in captures.vectors(path) if captured.result(row[-1]) != "zero"
        )
        alteration = result[:-1] + ("1" if result[-1] != "1" else "2")
        assert captured.call(*call) != captured.result(alteration)


def test_an_error_code_is_the_offset_of_its_message_in_the_rom():
    """The ROM stores the messages without their ``ERROR`` one behind the other."""
    offset = 0
    for kind, code in CODES.items():
        assert (kind, code) == (kind, offset)
        offset += len(kind)
