"""Explaining: causes that would make a differing page agree, each tested by replay.

Entry: `explanations` (`explain`, and `explain_copy` for a copy of the program).
"""
