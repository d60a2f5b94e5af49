"""Desks beside a plant as the web server sees them: drafts and versions of its files, and teaching."""
