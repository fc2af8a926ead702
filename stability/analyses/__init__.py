"""What can be asked of a closure on a flow; siblings that never import each other.

A package of their own, so that ``stability.neutral_curve`` is the function and never the module.
"""
