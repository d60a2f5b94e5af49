"""`arboleda simulate`: whole plants under virtual time, seed by seed, every step judged."""
