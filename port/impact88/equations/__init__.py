"""The mechanics as data: statements in several spellings, the mistakes that may be made in each,
and what the resulting programs compute."""
