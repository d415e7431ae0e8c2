"""This installation against the ROM's captures, and against a ROM on an independent 6502."""
