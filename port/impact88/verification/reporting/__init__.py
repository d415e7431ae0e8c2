"""Reporting: verdicts as text, as JSON and as a page for a case file."""
