"""The flight record: what went into the core and what came out of it, written beside a plant that runs."""
