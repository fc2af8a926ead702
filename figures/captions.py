"""The captions: what is seen. Parameters, assumptions and residuals are appended from the results."""

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
