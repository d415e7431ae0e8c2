"""Equations 13 to 18 for any unknowns: geometry, impulses, outcome, the solutions as a table."""
