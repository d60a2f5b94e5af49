"""Routes of drafts, trees, tries, teaching, proposals and versions."""
