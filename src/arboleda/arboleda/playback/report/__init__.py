"""The report of a task that failed: one file, out of its record and of forks of it."""
