"""Behavior trees as XML in the form of BehaviorTree.CPP: read and checked, pure and without a plant."""
