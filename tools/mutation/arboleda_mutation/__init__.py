"""Mutation testing: small bugs are planted in the core and the wire, and two judges look for each of them."""
