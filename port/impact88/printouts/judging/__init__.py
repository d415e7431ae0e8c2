"""Judging: every number and label of the paper against the program's page for the scene.

Entry: `judgement` (`judge`). `copies` judges by copies of the program, and `beside` adds
what a printout cannot show.
"""
