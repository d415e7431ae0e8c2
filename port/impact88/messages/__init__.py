"""Messages to users: arguments of a wrong type, progress, text tables, JSON forms."""
