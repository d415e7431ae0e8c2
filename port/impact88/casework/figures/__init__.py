"""Figures (extra `plot`): every drawing the project makes, each in its own module."""
