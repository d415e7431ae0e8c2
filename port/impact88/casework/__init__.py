"""Casework: what a forensic engineer asks of a collision besides its final velocities.

`reconstruction` works back from what was found to the speeds before; `uncertainty` gives bounds
and sensitivities, `optimization` their extremes; `chapter` holds the chapter's other problems and
its data; `figures` draws; `report` writes the page for the case file.

Needs: `collision`, `mechanics`, `program` (scenes, the listing in double precision), `printouts`
(a report quotes a verdict).
In: a collision as `collision.case` resolved it. Out: results with their limits, SVG, HTML.
Way: `reconstruction.answer` or `uncertainty.bounds`, then `figures.sceneview`, `report.findings`.
Used by: `conformance` (crash tests), `bench` (charts); forensic engineers, through `reconstruct`,
`bounds`, `chapter`, `figure` and `report`.
"""
