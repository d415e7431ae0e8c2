"""Tables of scenes: files in the formats of `formats`, data frames, sweeps.

Needs: `apple` (which texts are numbers), `collision` (cases, units, needs, remarks), `mechanics`
(what a column may hold, the results), `program` (the results of 1988).
In: files, frames, ranges of a sweep; a block of rows at a time. Out: columns, and the same kind of
file or frame with the results.
Way: `table` (`open_reader`), `rows`, `rowsolver`, `table` (`open_writer`); frames by `frames`.
Used by: who has a million scenes (`impact88 solve`, `solve_frame`); `conformance`, which reads
other programs' tables.
"""
