"""Composition: plant file, parts, command line. The only code that knows everything."""
