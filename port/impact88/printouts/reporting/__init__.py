"""Reporting: verdicts as text, as JSON and as a page for a case file.

Entry: `examination` (`examine` for files, `verify` for a printout that was read already).
"""
