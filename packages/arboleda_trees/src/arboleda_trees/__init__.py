"""Behavior trees as XML, in the form of BehaviorTree.CPP 4: recipes of a plant, and trees for Groot2."""
