"""The mechanics as data: statements in several spellings, the mistakes that may be made in each,
and what the resulting programs compute.

Needs: nothing but the ground.
In: tables of text (`mechanics.txt`, `rules.txt`, `variants.txt`, `readings.txt`) and columns of
scenes. Out: every small edit of the mechanics, in words, and its results.
Way: `spelling` (programs as data), `edits`, `evaluation`; `wording` says an edit.
Used by: `printouts`, which explains a page, and `conformance`, which explains another program's
table: both ask which edit gives the numbers seen.
"""
