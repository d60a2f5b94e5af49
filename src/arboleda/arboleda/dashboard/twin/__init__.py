"""The digital twin: what is drawn where, and how sure that is."""
