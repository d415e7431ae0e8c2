"""The user's own Apple II Plus ROM as a witness, on py65, an independent 6502 emulator."""
