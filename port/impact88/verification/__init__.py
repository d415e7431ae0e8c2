"""Is a printout what the program prints: reading, recovering, judging, explaining, reporting."""
