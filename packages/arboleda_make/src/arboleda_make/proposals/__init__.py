"""Proposals of assistants: what is kept of them, who approves them, and the tasks given after that."""
