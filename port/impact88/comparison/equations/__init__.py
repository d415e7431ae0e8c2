"""The mechanics as data: statements in several spellings, everything that may be written wrong in
one, and what the programs that come of it compute."""
