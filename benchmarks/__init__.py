"""Speed and accuracy against named baselines: `make bench` writes RESULTS.md, X2.csv and the figure X2."""
