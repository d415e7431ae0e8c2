"""Check arguments against annotations, and describe annotations in words."""

from __future__ import annotations

import collections.abc as abc
import inspect
import numbers
import sys
import types
import typing
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from ..errors import quoted

MAX_ITEMS = 1000  # items of an argument that are checked


def misfit(
    function: Callable[..., Any], args: tuple[Any, ...], keywords: dict[str, Any]
) -> str | None:
    """Return a message on the first argument that does not fit its annotation; None if all fit, or
    if the call does not match the function's signature."""
    signature = inspect.signature(function)
    try:
        arguments = signature.bind(*args, **keywords).arguments
    except TypeError:
        return None
    for name, value in arguments.items():
        parameter = signature.parameters[name]
        hint = _resolve(parameter.annotation, function)
        if parameter.kind is parameter.VAR_POSITIONAL:
            pairs = [(name, item) for item in value]
        elif parameter.kind is parameter.VAR_KEYWORD:
            pairs = list(value.items())
        else:
            pairs = [(name, value)]
        for label, item in pairs:
            if not fits(item, hint):
                return f"{label} is {_describe_value(item)}; expected {describe(hint)}"
    return None


def _describe_value(value: object) -> str:
    """Return a value for a message, or its type if it is long."""
    text = quoted(value)
    plain = isinstance(value, str | bytes | numbers.Number | None)
    return text if plain or len(text) < 30 else f"of type {type(value).__name__}"


def _resolve(annotation: object, function: Callable[..., Any]) -> Any:
    """Return the type of an annotation; Any if it cannot be resolved."""
    if annotation is inspect.Parameter.empty:
        return typing.Any
    if not isinstance(annotation, str):
        return annotation
    module = sys.modules[function.__module__]
    names = {**vars(typing), **vars(abc), **vars(module)}
    try:
        return eval(annotation, names)  # a source text of this package
    except (NameError, AttributeError, TypeError):
        return typing.Any


def fits(value: object, hint: Any) -> bool:
    """Return True if a value, with the items of a collection, is of the annotation's type."""
    origin, args = typing.get_origin(hint), typing.get_args(hint)
    if hint is None or hint is type(None):
        return value is None
    if origin in (typing.Union, types.UnionType):
        return any(fits(value, choice) for choice in args)
    if origin is typing.Literal:
        return any(type(value) is type(choice) and value == choice for choice in args)
    if hint is bool:
        return isinstance(value, bool) or type(value).__name__ in ("bool", "bool_")
    if hint in (int, float):
        kind = numbers.Integral if hint is int else numbers.Real
        return isinstance(value, kind) and not isinstance(value, bool)
    if origin is abc.Callable or hint is abc.Callable:
        return callable(value) and _takes(value, args)
    kind = origin or hint
    if hint is Any or not isinstance(kind, type):
        return True  # a type variable, a numpy alias
    if not isinstance(value, kind):
        return False
    return not args or _items_fit(value, kind, args)


def _takes(function: Callable[..., Any], args: tuple[Any, ...]) -> bool:
    """Return True if a function accepts the number of arguments of ``Callable[args]``, or has no
    signature."""
    if not args or not isinstance(args[0], list):
        return True
    try:
        signature = inspect.signature(function)
    except (TypeError, ValueError):
        return True
    try:
        signature.bind(*args[0])
    except TypeError:
        return False
    return True


def _items_fit(value: Any, kind: type, args: tuple[Any, ...]) -> bool:
    """Return True if the items of a collection are of the types in its annotation."""
    if issubclass(kind, Mapping):
        items = list(value.items())[:MAX_ITEMS]
        return all(fits(key, args[0]) and fits(item, args[-1]) for key, item in items)
    if issubclass(kind, tuple) and Ellipsis not in args:
        return len(value) == len(args) and all(map(fits, value, args))
    if issubclass(kind, abc.Iterable) and isinstance(value, abc.Collection):
        if isinstance(value, str):  # a text is a sequence of texts, but not a list of names
            return not issubclass(kind, abc.Sequence) and args[0] is str
        items = [item for item, _ in zip(value, range(MAX_ITEMS), strict=False)]
        return all(fits(item, args[0]) for item in items)
    return True  # an iterator can be consumed only once


WORDS: dict[Any, str] = {
    Any: "any value",
    None: "None",
    type(None): "None",
    str: "text",
    bytes: "bytes",
    int: "a whole number",
    float: "a number",
    bool: "True or False",
}


def describe(hint: Any) -> str:
    """Return an annotation in words: ``str | Sequence[str]`` is "text or a sequence of text"."""
    origin, args = typing.get_origin(hint), typing.get_args(hint)
    if hint in WORDS:
        return WORDS[hint]
    if origin in (typing.Union, types.UnionType):
        return _join_choices(map(describe, args))
    if origin is typing.Literal:
        return _join_choices(map(repr, args))
    if origin is abc.Callable or hint is abc.Callable:
        if not args or not isinstance(args[0], list):
            return "a function"
        return f"a function of {len(args[0])} value{'s' * (len(args[0]) != 1)}"
    kind = origin or hint
    name = getattr(kind, "__name__", "another value")
    if not isinstance(kind, type):
        return str(name)
    article = "an" if name[0] in "AEIOU" else "a"
    if issubclass(kind, Mapping) and len(args) == 2:
        return f"a mapping of {describe(args[0])} to {describe(args[1])}"
    if args and issubclass(kind, abc.Iterable):
        items = [describe(item) for item in args if item is not Ellipsis]
        return f"{article} {name.lower()} of {_join_choices(items)}"
    return f"{article} {name}"


def _join_choices(choices: Iterable[str]) -> str:
    """Return choices in words: "a, b or c"."""
    *first, last = dict.fromkeys(choices)
    return f"{', '.join(first)} or {last}" if first else last
