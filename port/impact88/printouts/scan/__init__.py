"""The paper itself: a scan or photograph read cell by cell, with the page's own glyphs.

Entry: `sheets` (`read_page`), called by `printouts.reporting.scanned`.
"""
