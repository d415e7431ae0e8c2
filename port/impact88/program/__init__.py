"""The 1988 program: the listing's port, its arithmetics, and the ways to run it.

Needs: `apple` (arithmetic, console, emulator), `collision` (cases, scene files, fields of the
page), `mechanics` (the compiled library, for many scenes at once; an MU that is a share). Core.
In: a scene as texts, or keys at the prompts. Out: the printed page, bit for bit, and its numbers.
Way: `scene`, then `run` by `listing` and one of `arithmetics`, `vectorized` for many scenes, or
`emulated` for the Apple itself.
Used by: who reproduces a printout (`impact88 run`, `replay`); `printouts` and `conformance`, which
hold papers and other programs against it; `tables`, `casework` and `bench`, which run its scenes.
"""
