"""A local web page, reachable from this computer only: printouts, collisions, the 1988 program."""
