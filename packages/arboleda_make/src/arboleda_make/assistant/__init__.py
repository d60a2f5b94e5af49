"""Assistants: what a language model may ask of a plant, over the Model Context Protocol."""
