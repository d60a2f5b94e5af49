"""Geometry of robots: bodies out of their URDF, and where their links are. Pure."""
