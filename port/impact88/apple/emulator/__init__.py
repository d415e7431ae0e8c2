"""An emulator that runs any Applesoft program: memory, screen, keyboard."""
