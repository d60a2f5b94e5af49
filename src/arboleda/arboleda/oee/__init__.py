"""OEE of a cell as a formula of its tasks and times."""
