"""JSON Schemas of forms that are written as lines, one for each field.

A form begins with ``title: ...`` and perhaps ``description: ...``; a blank line ends this head.
Then each line is a field, those of an object two blanks deeper than it: ``name: type -- meaning``,
``name?`` where it may be absent. ``$defs:`` stands before the parts that ``#name`` means.

Types are JSON's (``string``, ``number|null``), texts (``"a"|"b"``), one value (``= 4``), a part
(``#cell``), a list (``[T]``, ``[T]2..3``), an object of any names (``{T}``), one of several
(``T or T``), ``any``, and whatever else JSON Schema knows (``raw {...}``).
"""

import json
import re
from collections.abc import Iterator
from typing import Any

_DIALECT = "https://json-schema.org/draft/2020-12/schema"
_LINE = re.compile(r"(?P<indent> *)(?P<name>.+?)(?P<maybe>\?)?: (?P<type>.+?)(?: -- (?P<says>.*))?")
_SIZES = re.compile(r"\[(.*)\](?:(\d+)\.\.(\d+))?")
_OWN = {
    "schema": "name and number of this schema",
    "version": "version of impact88 that wrote the object",
}
"""Properties of every object that is printed by itself."""


def expand_form(lines: str, name: str) -> dict[str, Any]:
    """Return the JSON Schema of a form, called ``name``, from its lines."""
    head, _, body = lines.partition("\n\n")
    fields, _, parts = body.partition("$defs:\n")
    schema: dict[str, Any] = {"$schema": _DIALECT, "$id": name}
    schema |= dict(line.split(": ", 1) for line in head.split("\n"))
    if "raw" in schema:
        schema |= json.loads(schema.pop("raw"))
    if fields.strip():
        schema |= _object(_rows(fields))
        constants = {"schema": {"const": name, "description": _OWN["schema"]}}
        constants["version"] = {"type": "string", "description": _OWN["version"]}
        schema["properties"] = constants | schema["properties"]
        schema["required"] = [*constants, *schema.get("required", ())]
    if parts:
        schema["$defs"] = _object(_rows(parts))["properties"]
    return schema


_Row = tuple[int, re.Match[str]]


def _rows(text: str) -> list[_Row]:
    rows = []
    for line in filter(str.strip, text.split("\n")):
        match = _LINE.fullmatch(line)
        if match is None:
            raise ValueError(f"{line!r} is no field of a form")
        rows.append((len(match["indent"]), match))
    return rows


def _object(rows: list[_Row]) -> dict[str, Any]:
    """Return an object whose fields are the rows of least indent, with those below each."""
    properties, names = {}, []
    for row, below in _groups(rows):
        properties[row["name"]] = _with_type(row["type"], below)
        if row["says"]:
            properties[row["name"]]["description"] = row["says"]
        if not row["maybe"]:
            names.append(row["name"])
    schema = {"type": "object", "properties": properties}
    return schema | {"required": names} if names else schema


def _groups(rows: list[_Row]) -> Iterator[tuple[re.Match[str], list[_Row]]]:
    """Yield each row of least indent with those that follow it deeper."""
    starts = [at for at, (indent, _) in enumerate(rows) if indent == rows[0][0]]
    for start, stop in zip(starts, [*starts[1:], len(rows)], strict=True):
        yield rows[start][1], rows[start + 1 : stop]


def _with_type(text: str, below: list[_Row]) -> dict[str, Any]:
    """Return the schema of a type; ``below``: the fields of the object in it."""
    if text.startswith("raw "):
        schema: dict[str, Any] = json.loads(text[4:])
        return schema
    if text.startswith("= "):
        return {"const": json.loads(text[2:])}
    if text.startswith("#") and " or " not in text:
        return {"$ref": f"#/$defs/{text[1:]}"}
    if text.startswith("{"):
        return {"type": "object", "additionalProperties": _with_type(text[1:-1], below)}
    if match := _SIZES.fullmatch(text):
        item, low, high = match.groups()
        sizes = {"minItems": int(low), "maxItems": int(high)} if low else {}
        return {"type": "array", "items": _with_type(item, below), **sizes}
    if " or " in text:
        return {"anyOf": [_with_type(part, below) for part in text.split(" or ")]}
    if text.startswith('"'):
        return {"enum": json.loads(f"[{text.replace('|', ',')}]")}
    kinds = text.split("|")
    if below:
        return _object(below) | {"type": kinds if kinds[1:] else text}
    return {} if text == "any" else {"type": kinds if kinds[1:] else text}
