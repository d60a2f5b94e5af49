"""Cost lock: the Python calls of pinned scenarios, which do not depend on how fast or busy a machine is."""
