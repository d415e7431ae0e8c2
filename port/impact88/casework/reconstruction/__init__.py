"""Equations 13 to 18 solved for any unknowns: which impacts agree with what is known.

`unknowns` solves exact values, `adjustment` values with tolerances (entry: `reconstruct`).
`reconstructed` has the uncertainty of a reconstruction: draws and bounds (entries: `draws`,
`ranges`).

- `system`: the equations in scaled variables; `quadrics`: all their exact solutions.
- `posterior`: draws from the distribution that the known values define.
- `evidence`, `laws`: whether the measured values can all be true, and which laws they break.
- `solutiontable`, `reconstructedtable`: results as tables and as JSON.
"""
