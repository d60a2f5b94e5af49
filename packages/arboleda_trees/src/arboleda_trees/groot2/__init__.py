"""Trees for Groot2 and for other viewers of BehaviorTree.CPP."""
