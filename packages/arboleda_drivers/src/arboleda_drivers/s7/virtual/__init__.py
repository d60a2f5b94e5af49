"""The belt behind an S7: `arboleda virtual s7`."""
