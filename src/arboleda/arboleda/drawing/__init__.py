"""Drawings of trees from their rows, as `views/tree_view.py` and the status of a plant have them; pure."""
