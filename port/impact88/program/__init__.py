"""The 1988 program: the listing's port, its arithmetics, and the ways to run it."""
