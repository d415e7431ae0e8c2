"""The closed form over arrays: Equations 13 to 18 solved once, computed only as far as asked."""
