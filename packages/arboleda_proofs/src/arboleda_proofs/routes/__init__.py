"""Routes of faults by hand and of reports."""
