"""Parts of packages: what they are made of, and the plant as they see it."""
