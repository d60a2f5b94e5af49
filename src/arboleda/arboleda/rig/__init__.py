"""Rig: a plant, its bridge, broker and virtual boards in one process, under time that is handed to them."""
