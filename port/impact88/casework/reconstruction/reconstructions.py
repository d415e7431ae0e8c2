"""`impact88.reconstruct` and the list it returns."""

from collections.abc import Mapping

from ...collision.uncertain import Uncertain
from ...messages import notebook
from ...messages.arguments import explains_arguments
from .adjustment import reconstruct as find_impacts
from .answer import Answer
from .answertable import join_texts
from .solution import Reconstruction


class Reconstructions(list[Reconstruction]):
    """The impacts that agree with what is known, the likeliest first.

    A list, which a notebook shows as the command prints it.

    Parameters
    ----------
    iterable : iterable of Reconstruction, optional
        The impacts.

    Examples
    --------
    >>> known = {name: text for name, text in impact88.sample(1).items() if name != "MU"}
    >>> impacts = impact88.reconstruct({**known, "VAX": "-13.3 +- 0.5"})
    >>> [impact.redundancy for impact in impacts]
    [0]
    """

    def _repr_html_(self) -> str:
        """Return the output of `impact88 reconstruct --samples 0` as HTML for a notebook."""
        return notebook.preformatted_html(join_texts([Answer(impact, 0) for impact in self]))


@explains_arguments
def reconstruct(known: Mapping[str, Uncertain | float | str]) -> Reconstructions:
    """Return every impact that agrees with what is known of it.

    Equations 13 to 18 hold exactly, and so do exact values. Where more is known than needed, values
    with a tolerance are adjusted by least squares.

    Parameters
    ----------
    known : mapping of str to float, str or Uncertain
        What is known, by name (``UX`` ... ``WB``, ``VAX`` ... ``WBF``, ``E``, ``EM``, ``MU`` or
        ``MUP``, ``SA``, ``HA``, ``DVA``, ``PDOFA``, ``EL`` and so on), in one consistent set of
        units. The masses must be known. A number is exact; a text such as
        ``"41 +- 2"`` or an `Uncertain` is known within its tolerance. M is 6 where left out.

    Returns
    -------
    Reconstructions
        A list of `Reconstruction`: possible impacts before those that break physics, each group
        ordered by the sum of squared adjustments. Each has ``values``, ``adjusted``, ``evidence``
        (whether the measurements can all be true), ``deviations(names)`` and ``scene()``.

    Raises
    ------
    UserError
        For a name or a value that cannot be used, and for exact values that contradict one another
        beside others with a tolerance.
    UnsolvableError
        Where what is known determines nothing of what is not.

    Notes
    -----
    Equations 13 to 18 of the chapter; MU is the size of line 280, whose sign line 400 chooses.

    Examples
    --------
    >>> known = {name: text for name, text in impact88.sample(1).items() if name != "MU"}
    >>> best, *others = impact88.reconstruct({**known, "VAX": "-13.3 +- 0.5"})
    >>> round(best.values["VAX"], 1)
    -13.3
    """
    return Reconstructions(find_impacts(known))
