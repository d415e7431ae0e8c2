"""Judging: every number and label of the paper against the program's page for the scene."""
