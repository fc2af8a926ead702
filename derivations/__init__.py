"""The paper's equations derived again: one module per group, each ending in verdicts.

``python -m derivations`` runs all of them and writes VERDICTS.md; ``python -m derivations.irpf`` prints one group.
What the paper says of its own runs cannot be derived: `runs` judges it by the measurements kept in runs.json, which
``python -m derivations runs`` makes anew.
The paper's *printed* formulas are transcribed here and nowhere else; what is right comes from the package's closures.
"""

GROUPS = (
    "constitutive",
    "linearised",
    "plane_waves",
    "irpf",
    "perturbed",
    "leading",
    "flow_rules",
    "truncated",
    "cases",
    "beyond",
    "three_dimensions",
    "radial",
    "claims",
    "runs",
)
