"""Extremes of functions over a box: sequential linear programming and what is built on it."""
