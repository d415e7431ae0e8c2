"""Benchmarks: run time against error, measured in one run on one machine.

Needs: `mechanics` and `program` (the methods), `apple` (the Apple's operators), `casework`
(drawings).
In: populations of scenes. Out: tables, JSON, a figure.
Way: `methods`, `measure`, then `tables` and `figure`.
Used by: who has a million scenes and chooses a method for a machine of their own, and who changes
one (`impact88 bench`): speed is shown here, never by timed tests. What was measured stands in
`port/docs/speed.md` and `port/docs/measurements.md`.
"""
