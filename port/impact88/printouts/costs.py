"""Costs of what may have happened to a page on its way to a text, in wrong characters.

A cost is a negative log-likelihood in units of that of one character read or typed as another that
does not look like it. The reading with the least sum is taken; none of them is evidence by itself.
"""

WRONG = 1.0
"""A character for another, or a label: the unit. A label further up the page costs more."""
ALIKE = 0.3
"""A character for one that looks like it."""
SLIGHT = 0.03
"""What decides between equals only: a number written otherwise than Applesoft prints it, a label
passed over between two that were read, a less likely spelling."""
UNPAIRED = 0.6
"""A printed character, or a result, that is not in the text; a character, or a blank within a word
or number, that the program does not print there."""
CONTRADICTED = 3.0
"""A result that was read as another than the program prints."""
