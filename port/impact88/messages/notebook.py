"""HTML for notebooks: texts as the command line prints them."""


def preformatted_html(text: str) -> str:
    """Return a text as preformatted HTML."""
    from html import escape

    return f'<pre style="font-family: monospace">{escape(text)}</pre>'
