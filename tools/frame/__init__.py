"""Frame of the tools: what a person types, what a run tells, and how fuzzers run."""
