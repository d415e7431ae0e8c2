"""Benchmarks: run time against error, measured in one run on one machine."""
