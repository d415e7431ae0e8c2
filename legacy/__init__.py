"""The 1988 program as published, R. M. Brach's: listing, printouts, tables, and an account of them.

The listing, the printouts and the tables are from Raymond M. Brach's chapter "Vehicle Collision
Analysis" in *Automotive Engineering and Litigation* (Garland Law Publishing, New York, 1988).

``listing-as-printed.txt`` is the Appendix's listing as the chapter's text carries it, and
``impact.bas`` the same listing restored so that it runs. ``run1-as-printed.txt``,
``run2-as-printed.txt`` and ``table3-as-printed.txt`` are the three published printouts.
``table1.csv`` and ``table2.csv`` hold Tables 1 and 2, each cell as printed and as it must be read,
``emendations.csv`` the evidence for every cell that is not as printed or is doubtful.
``nhtsa-oblique-offset.csv`` and ``iihs-small-overlap.csv`` are tests that others published later,
numbers as they stand there: four oblique offset tests of the NHTSA with the results of a planar
impact model (Rose et al., SAE 2006-01-0908), and 21 small overlap tests with what was measured
(Brach's matrix, kept in the validation folder of the public repository joe-cormier/pycrash).
``ERRATA.md`` tells every difference, its evidence, and what cannot be restored.
"""
