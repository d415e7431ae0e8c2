"""Costs of what may have happened to a page on its way to a text, in wrong characters.

A cost is a negative log-likelihood in units of that of one character read or typed as another that
does not look like it. The reading with the least sum is taken; none of them is evidence by itself.
"""

WRONG = 1.0
"""A character for another: the unit."""
ALIKE = 0.3
"""A character for one that looks like it."""
SLIGHT = 0.03
"""What decides between equals: a number written otherwise than Applesoft prints it, a label of the
page passed over between two that were read, a less likely spelling."""
LOST = 0.6
"""A printed character, or a result, that is not in the text."""
FOREIGN = 0.5
"""A character, or a blank within a word or number, that the program does not print there."""
OTHER_LABEL = 0.9
"""A label in the place of another that does not look like it: less than a step back."""
CONTRADICTED = 3.0
"""A result that was read as another than the program prints."""
