"""Is a printout what the program prints: reading, recovering, judging, explaining, reporting.

Entry: `reporting.examination` (`examine`, `verify`), which takes these steps in order.
"""
