"""Hostile input of every kind, seeded: what no input may do to the command line.

``judge.py`` runs a case and says what is wrong with how it went; ``kinds.py`` makes cases;
``python tests/support/fuzz.py --help`` runs as many as wanted; ``tests/corpus/`` keeps what was
ever found, and ``tests/doors/test_fuzz.py`` does that and some seconds of new ones.
"""
