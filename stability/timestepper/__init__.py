"""Time-dependent flow in the hopper: mesh, equations, implicit steps."""
