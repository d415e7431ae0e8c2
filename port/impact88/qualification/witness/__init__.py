"""The user's own Apple II Plus ROM as a witness, on a 6502 that others wrote (extra: witness)."""
