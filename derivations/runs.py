"""What the paper says of its own runs (sections 5 and 6), judged by runs of the package's time-stepper.

Measured, not derived: the numbers come from runs.json, which `measured` writes. A threshold stands beside each
statement, with its reason.
"""

import numpy as np

from derivations.judged import SIGMAS, Runs, both, judge, named, per_run
from derivations.lengths import controlled, grid_dependent, oblique, root, scaled
from derivations.measured import load
from derivations.verdict import Kind, Verdict, show
from figures.fronts import RADII, SHOWING

TITLE = "What the text says of its runs (sections 5 and 6; figures N1 to N3)"


def first_place(runs: Runs) -> Verdict:
    """Judge where waves first show. Threshold: μ there within 10 % of its largest value, as flat as its top is."""

    def say(run: dict) -> str:
        (r, theta), (share, top, beside) = run["places"]["pressure"], run["viscosity"]["pressure"]
        return (f"at t = {run['first_time']:g} s around r = {r:g} m, θ = {theta:g}°; the initial μ there is "
                f"{share:.2f} of its largest value (at r = {top:g} m, θ = {beside:g}°)")  # fmt: skip

    shares = [run["viscosity"]["pressure"][0] for run in both(runs)]
    good = [named(run) for run, share in zip(both(runs), shares, strict=True) if share >= 0.9]
    return judge(
        "runs: first where μ is largest",
        "plane wave-like wavefronts in the stress develop near the center of the hopper ... where μ is largest",
        f"waves of p reach {SHOWING:.0%} of the largest p; " + per_run(runs, say) + "; threshold 0.9 of the largest μ",
        len(good) == 2,
        f"at {good[0]}; at the other ε the first come from the upper corners" if good else "the first waves come from "
        "the upper corners, where the inflow meets the walls; μ is largest lower down",
        "; ".join(f"μ is {share:.2f} of its largest value where waves first show, {named(run)}"
                  for run, share in zip(both(runs), shares, strict=True) if share < 0.9),
        Kind.HOLDS_IF if good else Kind.FAILS,
    )  # fmt: skip


def jump_in_troughs(runs: Runs) -> Verdict:
    """Judge that the shear is in the troughs. Threshold: twice the shear of the crests; a symmetric wave has 1."""

    def say(run: dict) -> str:
        return f"{run['troughs_at_first'][3]:.2f} when waves first show, {run['troughs'][3]:.2f} at the end"

    return judge(
        "runs: jumps across the troughs",
        "the tangential velocity component begins to develop jumps across the trough of each wavefront",
        "mean ‖V‖ in the troughs of the waves of p over that on their crests; " + per_run(runs, say) + "; threshold 2",
        all(run["troughs"][3] >= 2 for run in both(runs)),
        "shear gathers in the troughs by less than a factor of two",
        per_run(runs, say),
    )


def sharp(runs: Runs) -> Verdict:
    """Judge that they are jumps. Threshold: half of what a sine has of its period.

    A discontinuity takes two to four cells on a mesh of bilinear elements, which may be more than that: a steeper front
    than a sine, but no thicker than four cells, cannot be told from a jump.
    """

    def say(run: dict) -> str:
        thick, error, share, _ = run["thickness"]
        told = f"{1e3 * thick:.1f} ± {1e3 * error:.1f} mm, {thick / run['cell']:.1f} cells, {share:.2f} of a period"
        return f"{named(run)}: {told}"

    finest = runs["meshes"][-1]
    each = [*both(runs), *([finest] if finest["elements"] > runs["N3"]["elements"] else [])]
    steep = [run["thickness"][2] <= 1 / (2 * np.pi) for run in each]
    narrow = [run["thickness"][2] < 1 / np.pi and run["thickness"][0] <= 4 * run["cell"] for run in each]
    fits = [a or b for a, b in zip(steep, narrow, strict=True)]
    thin = ", ".join(named(run) for run, is_steep in zip(each, steep, strict=True) if is_steep)
    right = f"if a front that the mesh does not resolve is called a jump; it is thin enough on {thin or 'none of them'}"
    return judge(
        "runs: jumps, or steep waves",
        "jumps in tangential velocity that occur across the wavefronts",
        "thickness (size over steepest slope, along r) of the steepest changes of u_θ at the end; "
        + "; ".join(say(run) for run in each)
        + "; a sine has 0.32 of a period, threshold 0.16, or up to four cells, which a mesh cannot tell from a jump",
        all(steep),
        right if all(fits) else "u_θ changes smoothly, over more cells than the mesh needs",
        "; ".join(say(run) for run, is_steep in zip(each, steep, strict=True) if not is_steep),
        Kind.HOLDS_IF if all(fits) else Kind.FAILS,
    )


def normal(runs: Runs) -> Verdict:
    """Judge that the normal velocity is continuous. Threshold 0.1: what εΔp lets through is of the order of δ."""
    return judge(
        "runs: normal velocity",
        "the normal velocity components (not shown) are continuous across the bands",
        "normal part of the velocity gradient across bands, median over the 5 % of the nodes with most shear; "
        + per_run(runs, lambda run: f"{run['across'][0]:.3f}") + "; threshold 0.1",
        all(run["across"][0] <= 0.1 for run in both(runs)),
        "a part of the jump is normal to the band",
        per_run(runs, lambda run: f"{run['across'][0]:.3f}"),
    )  # fmt: skip


def downwards(runs: Runs) -> Verdict:
    """Judge that bands form further and further down: later at each lower radius."""
    return judge(
        "runs: further and further down",
        "these instabilities develop further and further down the hopper",
        f"mean amplitude of the waves of p on an arc reaches {SHOWING:.0%} of the largest p, at r = 1.2, 1.0, 0.8 m; "
        + per_run(runs, lambda run: f"at t = {', '.join(f'{t:g}' for t in run['arrivals'])} s"),
        all(np.all(np.diff(run["arrivals"]) > 0) for run in both(runs)),
        "they do not arrive in this order",
        per_run(runs, lambda run: f"at t = {run['arrivals']} s"),
    )  # fmt: skip


def cut_off(runs: Runs) -> Verdict:
    """Judge that growth ends. Threshold: a tenth of the first rate; without a limit the rate would rise."""

    def say(run: dict) -> str:
        return f"{run['early_growth']:.0f} /s up to the first waves, {run['late_growth']:.1f} /s in the last third"

    return judge(
        "runs: growth cuts off",
        "the growth of the wavefronts in amplitude does not increase without bound ... the growth appears to cut off",
        "rate of growth of the waves of u_θ (root mean square); " + per_run(runs, say) + "; threshold a tenth",
        all(run["late_growth"] <= 0.1 * run["early_growth"] for run in both(runs)),
        "growth slows down, but goes on",
        per_run(runs, say),
    )


def down_travel(runs: Runs) -> Verdict:
    """Judge that fronts travel down: at every radius by more than three standard errors."""

    def say(run: dict) -> str:
        each = (f"{c:.2f} ± {e:.2f} at {r:g} m ({u:.2f})"
                for r, (c, e, _, u) in zip(RADII, run["travel"], strict=True))  # fmt: skip
        return ", ".join(each)

    return judge(
        "runs: fronts travel down",
        "the wavefronts are observed to propagate down the hopper",
        "speed of the waves of p along rays in m/s, by least squares in space and time over the last two thirds, in "
        "brackets that of the material; " + per_run(runs, say) + f"; {fastest(runs)}",
        all(c + SIGMAS * e < 0 for run in both(runs) for c, e, _, _ in run["travel"]),
        "not at every radius",
        per_run(runs, say),
    )


def fastest(runs: Runs) -> str:
    """Return how the waves move against the material, at all radii of both runs."""
    low, *_, high = sorted(100 * (one[0] / one[3] - 1) for run in both(runs) for one in run["travel"])
    return f"{low:+.0f} to {high:+.0f} % of the speed of the material"


def unsteady(runs: Runs) -> Verdict:
    """Judge that nothing settles. Threshold: a correlation of 0.5; a steady state has 1."""
    return judge(
        "runs: no steady state",
        "no steady state emerges",
        "correlation of the last pattern of pressure waves with that 0.025 s before; "
        + per_run(runs, lambda run: f"{run['likeness']:.2f} at t = {run['end']:g} s") + "; threshold 0.5",
        all(run["likeness"] <= 0.5 for run in both(runs)),
        "the pattern settles",
        per_run(runs, lambda run: f"{run['likeness']:.2f}"),
    )  # fmt: skip


def dilating(runs: Runs) -> Verdict:
    """Judge the sign of delta in troughs. Threshold: nine of ten of the nodes."""

    def say(run: dict) -> str:
        share, low, high, _ = run["troughs"]
        return f"{share:.0%} of the nodes in troughs, mean δ {low:+.3f} there and {high:+.3f} on crests"

    return judge(
        "runs: δ > 0 in the troughs",
        "in the troughs of the plane-wave-like pressure disturbance, δ is positive",
        "at the end δ > 0 in; " + per_run(runs, say) + "; threshold nine of ten",
        all(run["troughs"][0] >= 0.9 for run in both(runs)),
        "not in all of them",
        per_run(runs, say),
    )


JUDGES = (
    first_place, jump_in_troughs, sharp, normal, downwards, cut_off, down_travel, unsteady, controlled, root, scaled,
    oblique, dilating, grid_dependent,
)  # fmt: skip


def verdicts(runs: Runs | None = None) -> list[Verdict]:
    """Return the verdicts of this group, on the measurements given or those of the repository."""
    runs = load() if runs is None else runs
    return [judged(runs) for judged in JUDGES]


if __name__ == "__main__":
    show(verdicts())
