"""The listing's Applesoft arithmetic over arrays, bit for bit."""
