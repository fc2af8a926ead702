"""The help pages of the commands. A line of one backspace keeps click from filling the paragraph after it."""

ABOUT = """\
Linear stability and well-posedness of granular flow.

Given the equations of a granular material (a closure) and a flow that they describe, this tool derives the tangent
matrix D of a plane-wave disturbance a exp(lambda t + i xi.x), D a = lambda a, and answers: which waves grow, in which
direction, how fast, and is there a shortest one (well-posed) or none (ill-posed)?

What is asked stands in a scene, a TOML file with the closure, the flow, their parameters and the grid of waves. It
is checked as a whole before anything runs, and every problem in it is listed at once. The answer is a netCDF file of
labelled arrays with units, which holds the scene, the assumed parameters, and how well the flow satisfies the
equations.

\b
Examples:
  stability list flows                     which flows there are, and their parameters
  stability explain figures/scenes/P2.1.toml   which model it would run, why, and at what cost
  stability run figures/scenes/P2.1.toml   growth rates of figure P2.1, into P2.1.nc
  stability derive perturbed --matrix truncated --format latex

\b
Scenes:    stability run --help shows a whole one; figures/scenes/ holds one per figure
Results:   import stability; ds = stability.open_results("P2.1.nc")
Terms:     closure, flow, parameters and their symbols: stability list

\b
Exit status:
  0    done
  2    bad input: each problem is one line "error: ..." with the place, the value and what is allowed
  3    numerical failure: the method did not converge, or the precision does not decide
  130  interrupted (Ctrl-C)

A bar on standard error shows progress on a terminal, a line every few seconds elsewhere. NO_COLOR is honoured.
"""

RUN = """\
Compute what SCENE asks for, write it as netCDF, and print a summary.

An existing result of that name is replaced once the new one is complete; nothing is written if the run fails.

\b
A scene:
  title   = "Plane waves on the radial hopper flow"
  closure = "perturbed"                  # stability list closures
  flow    = "radial_hopper"              # stability list flows
  [parameters]                           # printed; SI units, angles in degrees
  friction_angle = 34.0
  wall_friction_angle = 9.0
  epsilon = 2e-5
  [assumed]                              # not printed; each with its reason
  wedge_angle = { value = 15.0, why = "theta_w is not given" }
  outlet_radius = { value = 0.5, why = "r_0 is not given" }
  inlet_radius = { value = 1.5, why = "r_1 is not given" }
  gravity = { value = 9.81, why = "the standard value" }
  [request]
  kind = "growth_map"
  point = { r = 1.0, theta = 0.0 }       # left out for a uniform flow
  wavenumber = { from = 1.0, to = 2e4, count = 400, spacing = "log" }
  wave_angle = { from = 0.0, to = 360.0, count = 1441 }
  matrix = "auto"                        # or full (D), truncated (D'), leading (M)
  [tolerance]                            # left out: nothing is approximated
  growth = 1e-3                          # of the largest growth rate

\b
Kinds of request:
  growth_map      wavenumber, wave_angle, point, matrix; sampling = "auto", "grid" or "adaptive"; frequency = true
                  asks for it, false leaves it out
  neutral_curve   wave_angle, point, matrix; wavenumber = { from, to } limits the search; resolve = 0.05 inserts
                  directions until ln(wavenumber) steps by less along the curve
  phase_diagram   delta, scaled_wavenumber; closure perturbed, flow uniform_strain, friction_angle alone;
                  growth = false asks for the regions alone

An axis is { from, to, count, spacing = "linear" or "log" }, both ends included, or a list of increasing numbers.

\b
The table [tolerance] of a growth map, each entry optional:
  growth    the error allowed, relative to the largest growth rate (to its own rate where a wave decays faster): the
            cheapest matrix and precision that hold it are taken; without it nothing is approximated
  accuracy  "draft" (float32), "standard" (float64), "certified" (float64, every sign proven), or "auto"
  sign      "certified" asks for proven signs too
  digits    evaluate in so many decimal digits (16 to 1000), and interpolate most of the map

What a scene names (matrix, sampling, accuracy) is taken even where it misses the tolerance: a warning then says so. The
plan, its reasons, and the predicted and true error are attributes of the result; stability explain SCENE shows the plan
alone.
"""

EXPLAIN = """\
Say how SCENE would be modelled, without running it: matrix, precision, sampling, why, with what error and cost.

\b
The ladder, the cheapest first:
  matrix     leading (M), truncated (D'), full (D)
  precision  draft (float32), standard (float64), certified (float64, every sign proven)
  sampling   closed-form boundary, exact neutral curve, adaptive map, full grid

Of matrix and precision the cheapest is taken whose error is within the tolerance: bounded where a bound suffices, else
measured at some hundred waves of the grid and counted three times. figures/scenes/ladder/ holds a scene for each rung.
"""
