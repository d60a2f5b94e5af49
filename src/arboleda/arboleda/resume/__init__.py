"""Restart at the step: where a running task stands, as it is kept, and its way back into the tree; pure."""
