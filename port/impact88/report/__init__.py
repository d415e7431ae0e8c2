"""Answers to a case, its drawing and its printable report."""
