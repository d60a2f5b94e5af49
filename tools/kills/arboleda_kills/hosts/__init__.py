"""A plant on several hosts, each a network namespace of this machine, under faults of hosts and links."""
