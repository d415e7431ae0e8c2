"""Pictures: is a scan, fax, photograph or PDF what the 1988 program prints?

picture     a file's pages as ink
pdfpages    pages of a PDF, rendered in a process of its own
grid        lines, pitch and cells of typed paper
cells       pictures of cells, and the page's own typeface
align       lines aligned with the program's rows
transcript  what is in every cell, measured against the predicted page
residue     ink that the transcript does not explain
verdict     the verdict of the transcript as a text, held back by cells and marks
exhibit     the page with its findings outlined
"""

from .verdict import PictureVerification, verify_page, verify_picture

__all__ = ["PictureVerification", "verify_page", "verify_picture"]
