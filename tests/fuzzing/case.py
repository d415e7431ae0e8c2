"""A case: what the command line is given, small enough to be kept as a file."""

from __future__ import annotations

import base64
import gzip
import json
from dataclasses import dataclass, field
from pathlib import Path

_OF_A_PRINTOUT = {b"INITIAL KE": 1, b"VBX=": 1, b"IA=": 1, b"WB=": 2}
"""Labels, and how often each stands on one."""


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
        texts = (*self.files.values(), self.stdin)
        return max(
            sum(data.count(mark) for data in texts) // often
            for mark, often in _OF_A_PRINTOUT.items()
        )

    def to_json(self) -> str:
        """The case as text; bytes packed."""
        return json.dumps(
            {
                "kind": self.kind,
                "arguments": self.arguments,
                "stdin": _packed(self.stdin),
                "files": {name: _packed(data) for name, data in self.files.items()},
                "seed": self.seed,
            },
            indent=1,
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


def read_corpus(folder: Path) -> dict[str, Case]:
    """The cases kept in a folder, by name."""
    return {
        path.stem: Case.from_json(path.read_text("utf-8")) for path in sorted(folder.glob("*.json"))
    }
