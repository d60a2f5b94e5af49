"""The page on many plants."""
