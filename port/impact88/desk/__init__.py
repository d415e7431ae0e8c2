"""The desk: the project's page for a browser on the same machine (`impact88 desk`).

Why Flask: requests are synchronous, so an asynchronous framework would only add an event loop to
keep computations out of. Flask escapes templates by default and brings the client the tests use;
Bottle and http.server would leave escaping, limits and headers to us. Its own server is for
development only, so waitress serves: pure Python, no dependencies, Windows included, with limits on
bodies and headers.

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
