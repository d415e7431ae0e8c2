"""Casework: printouts read, verified digit by digit, explained and reported."""
