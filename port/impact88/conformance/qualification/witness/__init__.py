"""The user's own Apple II Plus ROM as a witness, on py65, an independent 6502 emulator.

For who must show in court that the captures kept in ``golden`` are what a ROM answers: the ROM may
not be passed on, so that everybody runs their own (`impact88 witness`). It makes new captures, too.
"""
