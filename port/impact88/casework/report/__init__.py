"""A page for the case file: what was found of one collision, to print and to sign."""
