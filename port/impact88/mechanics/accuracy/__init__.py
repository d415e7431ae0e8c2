"""Accuracy: the 50-digit reference, the listing's elimination in double, error bounds."""
