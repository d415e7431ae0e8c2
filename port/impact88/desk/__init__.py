"""The desk: the project's page for a browser on the same machine (`impact88 desk`).

Why Flask: what happens here is synchronous (a form's values in, an answer out), so an asynchronous
framework (Starlette, FastAPI, with anyio and uvicorn beneath) would bring an event loop that every
computation has to be kept out of. Flask is the oldest of the maintained ones, says which release
changes what, escapes templates by default, and comes with the client its tests use; Bottle and
http.server would leave escaping, limits and headers to us. Its own server says it is for
development only, so waitress serves: pure Python, no dependencies, Windows included, with limits on
bodies and headers of its own.

- `serving`: the socket, the address with its token, start and end
- `guard`: who may ask: Host, token, Origin, and the headers that go with every answer
- `app`: addresses and what answers them
- `halfopen`: connections that send no whole request
- `workers`: processes for what takes long, so that a newer question can end an older one
- `paper`, `collision`, `reconstruction`: the answers of the views; `forms`: their entries
- `page`: the template's values
- ``templates/``, ``static/``: the page, one style sheet, JavaScript modules

No mechanics, no reading of numbers and no wording of a verdict stands here: this room calls what
the commands call.
"""
