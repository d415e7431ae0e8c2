"""Benchmarks: run time against error, measured in one run on one machine.

Needs: `mechanics` and `program` (the methods), `apple`, `casework` (the figure).
In: populations of scenes. Out: tables, JSON, a figure.
Used by: who decides which method to use, or changes one (`impact88 bench`).
"""
