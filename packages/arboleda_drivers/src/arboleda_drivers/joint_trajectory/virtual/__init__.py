"""A virtual joint trajectory controller: `arboleda virtual trajectory`."""
