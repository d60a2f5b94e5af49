"""The playground: a plant with virtual devices in a tab of a browser, with the page's own parts.

Nothing else imports it. All of it is pure but `plants.py`, which reads files, and `tab.py`, which the tab's
worker runs. `scripts/playground` makes the site of it and of what is in `static/`.
"""
