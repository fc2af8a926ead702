"""The time-stepper checked by the linear theory, and the theory by the time-stepper.

Five checks, from the strictest on: plane waves in a periodic cell, the discrete symbol of the hopper's mesh, modes of
the discrete Jacobian, the first waves in the hopper, and what a wave becomes when it is no longer small.
"""
