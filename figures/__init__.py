"""The figures of the paper, redrawn: `python -m figures [NAME ...]`."""
