"""Checks: this installation against the ROM's captures, other programs against this one."""
