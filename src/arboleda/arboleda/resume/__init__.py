"""Restart at the step: the trail of a running task is kept, and leads the next start back to it; pure."""
