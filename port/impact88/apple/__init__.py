"""The Apple II Plus: its arithmetic and text (`applesoft`), and the machine (`emulator`).

Needs: nothing but the ground. Core.
In: decimal texts, Applesoft programs, keys; the captures of a real ROM that it is held against
(`captured`). Out: five-byte reals, printed text, screens.
Way: `applesoft.decimaltext`, `applesoft.real`, `applesoft.console`; programs: `emulator.machine`.
Used by: `program`, which runs the 1988 listing; every wing that reads or prints a number as it
does; anyone with another Applesoft program (`impact88 basic`). It knows nothing of collisions.
"""
