"""Applesoft's reals, functions, decimal text and console, as the ROM computes them."""
