"""Run time against error of every way to compute an impact, measured in one run."""
