"""What lies beyond the range of doubles: computed without remarks, and said in words at the end."""

from collections.abc import Callable
from functools import wraps
from typing import ParamSpec, TypeVar

import numpy as np

from ..errors import BEYOND_DOUBLES, UserError

P = ParamSpec("P")
R = TypeVar("R")


def within_doubles(function: Callable[P, R]) -> Callable[P, R]:
    """``function`` without numpy's warnings; a matrix that holds what is not finite, and so has no
    decomposition, is a UserError."""

    @wraps(function)
    def quiet(*arguments: P.args, **options: P.kwargs) -> R:
        with np.errstate(all="ignore"):
            try:
                return function(*arguments, **options)
            except np.linalg.LinAlgError:
                raise UserError(BEYOND_DOUBLES) from None

    return quiet
