"""The machine that runs any Applesoft program: memory, screen, keyboard. No collisions here."""
