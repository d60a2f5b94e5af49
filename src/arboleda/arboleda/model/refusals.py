"""Words that refuse commands. Those of boards are on the wire, in Spanish; a bridge or a driver adds its own.

Records and topics carry the words. Code says a word by its name here.
"""

from __future__ import annotations

OLD = "viejo"
RETAINED = "retenido"
LATE = "tarde"
FORMAT = "formato"
LIMIT = "limite"
NOT_HOMED = "sin_ref"
STOPPED = "paro"
BUSY = "ocupado"
CONDITION = "condicion"

NO_LINK = "no_link"
NO_STOP = "no_stop"
NO_HOME = "no_home"
OLD_EPOCH = "old_epoch"
FOREIGN = "foreign"  # it is of another node
OTHER_BRIDGE = "other_bridge"  # its board is another bridge's

WORDS = frozenset(word for name, word in [*globals().items()] if name.isupper())
"""All of them."""
