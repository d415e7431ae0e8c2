"""Other programs against this one: the oracle, test vectors, tables of results, causes of
differences."""
