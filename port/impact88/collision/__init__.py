"""A collision: its values by name, as texts, numbers and ranges, with their units and estimates.

Needs: `apple`, whose rule says which texts are numbers. Core.
In: files, forms and mappings, as people write them. Out: a case resolved once, its values in base
units or as texts; the geometry of the vehicles; remarks on what is hardly meant.
Way: `scenefile` (a file's texts), `case` (`Case`), then `doubles` or `uncertain` (numbers, ranges).
Used by: every wing that takes a collision, so that all of them understand one alike.
"""
