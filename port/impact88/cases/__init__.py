"""One collision as a file, a form or a mapping describes it: units, tolerances, axes, headings."""
