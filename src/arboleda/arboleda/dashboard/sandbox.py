"""Policy of pages with scripts of their own and words from outside: they reach nothing of this plant."""

POLICY = (
    "sandbox allow-scripts allow-downloads; default-src 'none'; script-src 'unsafe-inline'; "
    "img-src data:; style-src 'unsafe-inline'; frame-ancestors 'none'"
)
