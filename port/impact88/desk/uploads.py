"""Files that the page hands over to be read into a form."""

from __future__ import annotations

from ..errors import UserError
from ..files import decode
from ..scene import SOURCE, toml_texts

LARGEST = 1_000_000


def small_toml(data: bytes, name: str) -> dict[str, str]:
    """The entries of a flat TOML file as texts. Raises UserError naming file and line."""
    if len(data) > LARGEST:
        raise UserError(f"is larger than {LARGEST:,} bytes, the most that is read here", name)
    texts = toml_texts(decode(data, name), name)
    return {n: text for n, text in texts.items() if n != "case" and not n.endswith(SOURCE)}
