"""What a user is told: arguments of a wrong kind, progress, tables to read, JSON forms."""
