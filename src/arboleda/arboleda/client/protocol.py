"""Names and times that the server and its clients have in common."""

from __future__ import annotations

PLANT = "arboleda-plant"  # header by which a client names the plant it means
COMMAND_LINE = "arboleda"  # the User-Agent of our own command, before its version
BEAT_S = 15.0  # after so long without a change a stream says that it is still there
