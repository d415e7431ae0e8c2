"""What a notebook is shown: texts as the command line prints them."""


def preformatted(text: str) -> str:
    """A text as a piece of HTML that shows it as it stands."""
    from html import escape

    return f'<pre style="font-family: monospace">{escape(text)}</pre>'
