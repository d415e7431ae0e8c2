"""Recovery: the scene whose page explains the paper at the least cost.

Entry: `recovered` (`recover`).
"""
