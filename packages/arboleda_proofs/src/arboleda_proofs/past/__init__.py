"""The page on a record: the plant as it was, to look at only."""
