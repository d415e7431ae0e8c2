"""Is a printout what the program prints: reading, recovering, judging, explaining, reporting.

Needs: `program` (the page for a scene), `equations` (mistakes in a copy), `mechanics` (a first
scene), `collision` (fields, scenes), `apple` (numbers as they are printed and typed).
In: text, a picture or a PDF of a page. Out: a verdict, every number with what was read, what would
explain the differences.
Way: `reporting.examination` (`examine`) goes through `reading` or `scan`, `recovery`, `judging` and
`explaining`.
Used by: who validates historical casework (`impact88 verify`, the desk); `casework`'s report.
"""
