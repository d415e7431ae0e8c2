"""Messages for arguments of a wrong type.

Public functions use their arguments without checking types first, so that valid calls cost nothing.
If one fails, its arguments are checked against its annotations: one that does not fit becomes a
UserError that names it; if all fit, the error is a bug and is raised unchanged.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps

from ..errors import UserError

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any, TypeVar

    Function = TypeVar("Function", bound=Callable[..., Any])

FAILURES = (TypeError, ValueError, AttributeError, LookupError, ArithmeticError)
"""Exceptions of Python and numpy for a value of a wrong type."""


def explains_arguments(function: Function) -> Function:
    """Return ``function`` with a UserError for an argument that its annotations exclude.

    Parameters
    ----------
    function : callable
        A function or method with annotations. One that cannot be resolved (a type that only a
        type checker imports) admits anything.

    Returns
    -------
    callable
        Calls ``function``; if that fails and an argument does not fit its annotation, raises
        UserError naming function and argument.

    Examples
    --------
    >>> from impact88.messages.arguments import explains_arguments
    >>> @explains_arguments
    ... def half(number: float) -> float:
    ...     return number / 2
    >>> half(3)
    1.5
    >>> half("3")
    Traceback (most recent call last):
    ...
    impact88.errors.UserError: half: number is '3'; expected a number
    """

    @wraps(function)
    def call(*args: Any, **keywords: Any) -> Any:
        try:
            return function(*args, **keywords)
        except UserError:
            raise
        except FAILURES as error:
            from .argumentkinds import misfit  # inspect and typing take 10 ms to import

            if (reason := misfit(function, args, keywords)) is None:
                raise
            raise UserError(reason, function.__name__) from error

    return call  # type: ignore[return-value]
