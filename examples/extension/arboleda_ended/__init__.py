"""Ended tasks of each cell: counted, kept, and told by a command, over HTTP and on the page."""

from arboleda.extension import Phrase

ENDED = Phrase("ended.here", "tasks that ended here")
