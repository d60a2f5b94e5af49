"""Error of an edit, with a sentence for people."""

from __future__ import annotations

from arboleda.extension import PayloadError


class EditError(PayloadError):
    """Error: the operation cannot be done on this text; nothing was changed."""
