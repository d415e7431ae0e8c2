"""Printouts: is a text, or the text of a picture, what the 1988 program prints?

glyphs    a text as characters with the gaps between them
page      the program's page: rows, labels, places of numbers
labels    the labels that were read exactly, in the page's order
align     the text between two labels, aligned with the cells between them
reader    the printouts of a text, number by number
search    the scene they come from, by exact replay
verdict   the comparison with that scene's page
findings  the kinds of findings, and the verdict that follows from them by one table
explain   what explains a page that differs
sources   texts and files
words     verdicts in words and as JSON
"""

from .findings import VERDICTS, Finding, Kind, Number, Verdict, Verification
from .sources import verify
from .verdict import judge

__all__ = ["VERDICTS", "Finding", "Kind", "Number", "Verdict", "Verification", "judge", "verify"]
