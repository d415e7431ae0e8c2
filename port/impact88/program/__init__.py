"""The 1988 program: its listing ported line by line, and compiled for many scenes.

``scene``: the values as typed; ``listing``: the port, run by ``run`` in one of ``arithmetics``;
``compiler``: the listing, or a copy of it, as steps, which ``generate`` prints as C and ``kernel``
runs in ``applesoft.c``; ``replay``: columns of scenes; ``copies``: an office's copy of the listing,
and the listing in the emulator.
"""
