"""The captions: what is seen. Parameters, assumptions, residuals and runs are appended from the results."""

from xarray import Dataset

from figures.fronts import SHOWING, place, visible

I1 = """Schematic of a shear band: two blocks of grains slide past each other. Nearly all shear, and with it the jump of
the velocity u, is taken up by a band only several grain diameters d thick and as long as the container. Dark: grains
that stood in one column before shearing. Right: the velocity profile; dotted: the discontinuity to which it tends in a
continuum without a length scale. Nothing is computed or assumed: the grains are a random packing from a fixed seed."""

L1 = """Growth rate Re lambda_2 of plane waves on the radial hopper flow, rigid-plastic equations (L4). Radius:
wavenumber |xi|, logarithmic; angle: direction of the wavevector from e_r (the major principal stress is along e_theta).
Full line: Re lambda_2 = 0. Between waves across the stress characteristics (dotted, {stress}) and across the velocity
characteristics (dashed, {velocity}), which are the exact edges of the four wedges for short waves, growth rises with
|xi|^2 without bound: the equations are ill-posed in Hadamard's sense. Hatched: below |xi| = {least:.2g} to {most:.2g}
1/m, depending on direction, every wave seems to grow, but it is longer than the hopper, along which the coefficients
vary: the growth rate has no meaning there."""

P1 = """Stability of the truncated tangent matrix D' (P7) over the rate of dilation delta (P4.5) and Lambda epsilon = mu
|xi|^2 epsilon/2, for two friction angles. Full line: exact boundary, below which waves of at least one direction grow;
colours: the largest growth rate over all directions, times epsilon. Dotted: the exact limits of delta, named above,
with k = sqrt(2) sin(friction angle). Between the inner two, waves of some direction grow at every wavelength, at a
bounded rate; between the outer two, only long enough waves grow; beyond, none. Above 45 deg, k > 1 and the inner upper
limit is 1; above 49.94 deg the outer upper limit changes form. The hopper flow of figures L1 and P2.1 (-0.002 < delta <
0) cannot be told from the line delta = 0 here."""

P2_1 = """(a) Growth rate Re lambda_2 and neutral curve Re lambda_2 = 0 (full line) of the full tangent matrix D on the
radial hopper flow, perturbed equations. Radius: wavenumber |xi|, logarithmic; angle: direction of the wavevector from
e_r. Waves inside the four tongues grow, waves in the white region decay. Dashed and dotted: the edges of the wedges in
which the unperturbed equations are unstable (figure L1). Circle: the fastest wave, {fastest}. Hatched: waves below |xi|
= {least:.2g} to {most:.2g} 1/m, depending on direction, are longer than the hopper, along which the coefficients vary:
the growth rate has no meaning there. (b) One tongue over the angle that is left to the null direction of M at 45 deg,
so that its tip can be seen. The neutral curve closes at |xi| = {closed}: no shorter wave grows in any direction."""

N1 = """Average stress in the hopper, t = {times}. Wavefronts of two families appear in the upper half, sharpen into
bands, and fill the hopper downwards. {first} By local theory the fastest waves are 3 to 3.5 cm long: four cells of the
4,000 elements that the paper had, which lengthen them."""

N2 = """Radial slices at theta = {angle} deg of the average stress (left) and of the tangential velocity (right), from
the run of figure N1. The tangential velocity jumps across the bands. {first}"""

N3 = """(a) Radial slices at theta = {angle} deg of the average stress, each shifted by -1 m2/s2 from the one above.
{beside}{first} (b) Its waves on the same ray: the average stress less its smooth part. Full line: the path of a wave at
the speed measured from t = {after} s on by least squares, {speeds}; dashed: the path of the material. (c) Wavelength of
the first waves, at t = 500 epsilon: geometric means and standard errors over four windows along the axis, at r =
{windows} m. Full line: the power law through them, with an exponent of {exponent}; sqrt(mu epsilon) has 1/2."""


def first_seen(ds: Dataset) -> str:
    """Return a sentence on when and where waves first show in a run."""
    try:
        first = ds.isel(time=visible(ds))
    except ValueError:
        return f"No wave of the average stress reaches {SHOWING:.0%} of its largest value."
    r, theta = place(first, "pressure")
    return (
        f"Snapshots begin where waves of the average stress first reach an amplitude of {SHOWING:.0%} of its largest "
        f"value: at t = {first.time.item():.4g} s, around r = {r:.3g} m, theta = {theta:.3g} deg."
    )


F1 = """The flow field of the run of figure N3, judged at every node as if it had come from somewhere else, before and
after bands have formed. Above: the verdict on plane waves of the perturbed equations about the state there; below: the
e-folds that the fastest wave of two cells makes in {duration:g} s. {answers}"""
