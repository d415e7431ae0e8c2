"""Messages to users: arguments of a wrong type, progress, text tables, JSON forms.

Ground, as `names`, `status`, `errors`, `files` and `version` are: it needs none of the wings.
In: what a function or command found. Out: one line, a table of text, a form with its schema.
Used by: every wing that tells a user something.
"""
