"""The desk: the project's page for a browser on the same machine (`impact88 desk`).

Flask escapes templates, brings limits and a client for tests; waitress serves, pure Python, with
limits on bodies and headers. `app` has the addresses, `guard` says who may ask, `workers` do what
takes long. No mechanics, no reading of numbers and no wording of a verdict stands here: this room
calls what the commands call.
"""
