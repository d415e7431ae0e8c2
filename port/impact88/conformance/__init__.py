"""Conformance: other programs against this one, and this installation against the ROM.

`comparison` writes test vectors, compares tables of results and names the mistake behind a
difference; `qualification` replays the ROM's captures, and a ROM image on another 6502.

Needs: `apple`, `program` and `mechanics` (what is right), `collision`, `equations` (mistakes),
`tables` (other programs' results), `casework` (published crash tests, versions on a record).
In: tables of another program's results; captures. Out: verdicts, causes, vectors, the kit.
Way: `comparison.oracle`, `comparison.vectors`, `comparison.compare`; `qualification.selfcheck`.
Used by: developers of comparable programs (`oracle`, `compare`, `schema`), and whoever must show
that an installation is sound (`selfcheck`, `witness`).
"""
