"""The cell that the tests share: friction, strain rate and pressure of the hopper at (1 m, 0)."""

CELL = {"friction_angle": 34, "strain_rate": 2.092868095057769, "pressure": 3.9983}
EPSILON = 1e-4
