"""Hostile input of every kind, seeded: what no input may do to the command line.

``judge.py`` runs a case and says what is wrong with how it went; ``kinds.py`` makes cases;
``corpus.jsonl`` keeps what was ever found, one case a line, and ``tests/doors/test_fuzz.py`` runs
it and some seconds of new ones.
"""
