"""The paper itself: a scan or photograph, from ink to a verdict on every cell.

Its glyphs are the page's own. It finds the scene and judges by itself, with `recovery`'s search of
scenes and `judging`'s words; a picture that differs is not explained.

Entry: `sheets` (`read_page`), called by `printouts.reporting.scanned`.
"""
