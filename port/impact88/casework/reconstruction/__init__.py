"""Equations 13 to 18 solved for any unknowns: which impacts agree with what is known.

`unknowns` solves exact values, `adjustment` values with tolerances (entry: `reconstruct`).
`reconstructed` has the uncertainty of a reconstruction: draws and bounds (entries: `draws`,
`ranges`).

- `system`: the equations in scaled variables; `quadrics`: all their exact solutions.
- `admissible`: which impacts count; `coordinates`: those that meet all exact values; `posterior`:
  the distribution that the known values define over both; `sampler`: draws from it.
- `evidence`, `laws`: whether the measured values can all be true, and which laws they break.
- `solutiontable`, `reconstructedtable`: results as tables and as JSON.
"""
