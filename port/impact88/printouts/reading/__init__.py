"""Reading: a text as labelled numbers, each with the ways it may be read.

Entry: `printout` (`read_printouts`).
"""
