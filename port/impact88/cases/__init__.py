"""One collision as a file, a form or a mapping describes it: units, tolerances, axes, headings."""

from .amounts import Amount
from .case import Case
from .scenefile import TEMPLATES, template
from .units import PLAIN, View

__all__ = ["PLAIN", "TEMPLATES", "Amount", "Case", "View", "template"]
