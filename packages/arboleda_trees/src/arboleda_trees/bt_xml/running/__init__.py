"""Trees of XML as nodes of py_trees that run with the rules of BehaviorTree.CPP 4."""
