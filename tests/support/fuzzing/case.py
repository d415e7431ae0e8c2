"""A case: what the command line is given, small enough to be kept as a line of a file."""

from __future__ import annotations

import base64
import gzip
import json
import re
from collections import Counter
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

import captures

_LABEL = re.compile(rb"\b[A-Z]+=|COMPONENTS OF M[AB]")


@cache
def _labels() -> Counter[bytes]:
    """How often each label, or prompt, stands on a printout."""
    page = captures.ROOT / "legacy" / "run1-as-printed.txt"
    return Counter(_LABEL.findall(page.read_bytes()))


@dataclass
class Case:
    """``files``: what stands in the current folder; ``seed`` made it, where that is known."""

    kind: str
    arguments: list[str]
    stdin: bytes = b""
    files: dict[str, bytes] = field(default_factory=dict)
    seed: str = ""

    def printouts(self) -> int:
        """How many printouts, or pieces of some, `verify` is given."""
        if self.arguments[:1] != ["verify"]:
            return 0
        pages = b"\n".join((*self.files.values(), self.stdin))
        found = Counter(_LABEL.findall(pages.replace(b"\0", b"")))  # UTF-16 is read, too
        return max((found[label] // often for label, often in _labels().items()), default=0)

    def to_json(self) -> str:
        """The case as text; bytes packed."""
        return json.dumps(
            {
                "kind": self.kind,
                "arguments": self.arguments,
                "stdin": _packed(self.stdin),
                "files": {name: _packed(data) for name, data in self.files.items()},
                "seed": self.seed,
            }
        )

    @classmethod
    def from_json(cls, text: str) -> Case:
        """The case of `to_json`."""
        found = json.loads(text)
        files = {name: _unpacked(data) for name, data in found["files"].items()}
        return cls(
            found["kind"], found["arguments"], _unpacked(found["stdin"]), files, found["seed"]
        )


def _packed(data: bytes) -> str:
    """Plain text stays legible."""
    try:
        text = data.decode("ascii")
    except UnicodeDecodeError:
        text = "\0"
    if len(data) < 20_000 and all(c.isprintable() or c == "\n" for c in text):
        return f"text:{text}"
    return f"gzip:{base64.b64encode(gzip.compress(data, mtime=0)).decode()}"


def _unpacked(text: str) -> bytes:
    form, _, body = text.partition(":")
    return body.encode() if form == "text" else gzip.decompress(base64.b64decode(body))


def read_corpus() -> dict[str, Case]:
    """The cases that are kept, by name: one a line."""
    lines = Path(__file__).with_name("corpus.jsonl").read_text("utf-8").splitlines()
    return {json.loads(line)["name"]: Case.from_json(line) for line in lines}
