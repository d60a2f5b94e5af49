"""Changing a plant: drafts, versions, teaching, tries, and proposals of assistants."""
