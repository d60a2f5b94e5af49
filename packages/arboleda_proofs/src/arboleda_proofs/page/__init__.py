"""The page's sections on proofs: faults by hand, reports of failures, the demonstration."""
