"""The digital twin: everything that is drawn of a plant, with its place and how sure that is."""
