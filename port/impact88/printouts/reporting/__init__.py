"""Reporting: verdicts as text and as JSON; `casework.report` makes the page for a case file.

Entry: `examination` (`examine` for files, `verify` for a printout that was read already).
"""
