"""Equations 13 to 18 solved for any unknowns: which impacts agree with what is known.

`adjustment` finds the impacts (entry: `reconstruct`); `answer` has everything that follows from
each (entry: `answers`), `reconstructions` is `impact88.reconstruct`. Exact values are measurements
of no tolerance. `unknowns` solves the equations over arrays.
`drawsandbounds` has the uncertainty of a reconstruction: draws and bounds (entries: `draws`,
`ranges`).

- `system`: the equations in scaled variables; `quadrics`: all their exact solutions.
- `impactsearch`: the impacts that agree best, by `leastsquares`; `solution`: one of them in full;
  `nearest`: the nearest impact that physics allows, where none of them is.
- `admissible`: which impacts count; `coordinates`: those that meet all exact values; `posterior`:
  the distribution that the known values define over both; `sampler`: draws from it.
- `evidence`, `laws`: whether the measured values can all be true, and which laws they break.
- `answertable`: the first lines of an answer, for the command, the report and the desk, and tables;
  `answerremarks`, `answerjson`; `derived`: what follows from an impact's values.
"""
