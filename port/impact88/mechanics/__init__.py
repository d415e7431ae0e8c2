"""The planar impact in double precision: closed form, compiled kernels, accuracy, outcome.

Needs: `collision` (values by name, cases, units, ranges, geometry, angles in degrees), `apple`
(decimal texts of the reference). Core.
In: columns of numbers by the listing's names. Out: results by theirs, STATUS, bounds of rounding
errors; the compiled library (`native`), which `program` uses too.
Way: `closedform.solve`, other types by `closedform.general`, then `native` or numpy.
Used by: `impact88.solve`, and every wing that computes an impact: `casework`, `tables`,
`conformance`, `printouts`, `bench`; programs that import the package.
"""
