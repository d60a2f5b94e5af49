"""The report of a task that failed: one file, made of its record and of forks of it."""
