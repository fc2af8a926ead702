"""Eigenvalues where float64 is in trouble: seeded samples, their truth to 60 digits, and every method on them."""
