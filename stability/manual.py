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
  stability derive my_file.py:MY_CLOSURE   the matrix of a closure of your own
  stability resume N1.nc.checkpoint        go on with a march that was stopped

python -m stability is the same command. It takes no package from the present folder, where a scene from elsewhere may
have brought one; python -P -m stability does not look there for modules of Python itself either.

\b
Scenes:    stability run --help shows a whole one; figures/scenes/ holds one per figure
Results:   import stability; ds = stability.open_results("P2.1.nc")
Terms:     closure, flow, parameters and their symbols: stability list

\b
Exit status:
  0    done
  2    bad input: each problem is one line "error: ..." with the place, the value and what is allowed
  3    numerical failure: the method did not converge, or the precision does not decide
       (of a march, the message names the checkpoint that was written)
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

A closure (or a flow) of your own stands in a Python file: closure = "my_file.py:MY_CLOSURE". That file is executed,
with all that a program may do, and a line on standard error says so; this form of name alone executes anything. A
relative path is taken from the scene's folder and may not leave it; an absolute one may lie anywhere.

\b
Kinds of request:
  growth_map      wavenumber, wave_angle, point, matrix; sampling = "auto", "grid" or "adaptive"; frequency = true
                  asks for it, false leaves it out
  neutral_curve   wave_angle, point, matrix; wavenumber = { from, to } limits the search; resolve = 0.05 inserts
                  directions until ln(wavenumber) steps by less along the curve
  well_posedness  point, matrix ("full" or "truncated"): stable, unstable but bounded, or ill-posed; with which power of
                  the wavenumber short waves grow, in which directions, and because of which term
  smallest_cure   parameter, point: the least value of a parameter that makes the point well-posed or bounds growth;
                  see below
  field_map       the verdict at every point of a flow field in a file; see below
  phase_diagram   delta, scaled_wavenumber; closure perturbed, flow uniform_strain, friction_angle alone;
                  growth = false asks for the regions alone
  march           the flow in time from the base state on, radial_hopper or radial_hopper_compatible; see below
  crosscheck      the time-stepper against the linear theory; see below

An axis is { from, to, count, spacing = "linear" or "log" }, both ends included, or a list of increasing numbers.

\b
The table [tolerance] of a growth map, each entry optional:
  growth    the error allowed, relative to the largest growth rate (to its own rate where a wave decays faster): the
            cheapest matrix and precision that hold it are taken; without it nothing is approximated
  accuracy  "draft" (float32), "standard" (float64), "certified" (float64, every sign proven), or "auto"
  sign      "certified" asks for proven signs too
  digits    evaluate in so many decimal digits (16 to 1000), and interpolate most of the map

\b
The request of a march; what has a default here may be left out:
  [request]
  kind = "march"
  mesh = { kind = "polar", elements = 4000, half = true }   # or graded, diamond; half the wedge up to its symmetry line
  snapshots = { from = 0.0, to = 0.1, count = 11 }          # s; the run ends at the last one
  floor = 0.05                           # 1/s, the least ||V|| that the rheology sees
  step = { first = 1e-5, largest = 5e-4, smallest = 1e-9 }  # s; halved where Newton's method fails, else grown
  scheme = "backward_euler"              # or "bdf2"
  solver = "direct"                      # or "iterative"
  perturbation = { size = 1e-3, seed = 1 }   # random velocity over sqrt(g r_0); left out: none
  checkpoint_every = 20                  # accepted steps
  [tolerance]
  newton = 1e-9                          # the last update of Newton's method, relative to the scales of the fields

\b
The request of a smallest_cure, whose parameter stands nowhere else in the scene; all else may be left out:
  [request]
  kind = "smallest_cure"
  parameter = "epsilon"                  # or "viscosity", where one parameter of the closure has that in its name
  point = { r = 1.0, theta = 0.0 }       # left out for a uniform flow
  growth = 100.0                         # 1/s, which no wave may exceed; left out or 0: no short wave may grow
  bracket = { from = 1e-9, to = 1.0 }    # the values between which to look; left out: the parameter's range
  rtol = 1e-6                            # between a value that cures and one that does not
  longest = 0.5                          # m, of the waves that are looked at; left out: p/|grad p|

\b
The request of a field_map, with flow = "field" and the closure's parameters alone; all but the file may be left out:
  [request]
  kind = "field_map"
  file = "flow.vtu"                      # from the scene's folder; .nc, .vtu, .vts; with extras netCDF-4, .vtk
  fields = { u = "velocity:0", v = "velocity:1", p = "stress" }   # left out: u, v (or velocity) and p (or pressure)
  time = 0.1                             # s, of the snapshot; left out: the last
  density = 1500.0                       # kg/m3, which p is divided by; left out: p is stress over density
  duration = 1.0                         # s, over which e-folds are counted; left out: 1/||V|| of each point
  cells = 2.0                            # the wavelength that the mesh resolves least
  longest = 0.5                          # m, of the waves that are looked at; left out: the size of the field
  check = true                           # whether verdicts are tried over the error bars of the gradients

\b
The request of a crosscheck, for closures with epsilon; all but the point may be left out:
  [request]
  kind = "crosscheck"
  point = { r = 1.0, theta = 0.0 }       # whose strain rate and pressure the periodic cell has
  parts = ["cell", "neutral", "symbol", "hopper", "saturation"]
  elements = 2000                        # of the half hopper, in modes and runs
  mesh = "diamond"                       # or polar, graded
  duration = 0.045                       # s, of the runs in the hopper
  step = 5e-4                            # s
  noise = 1e-3                           # in the initial state of one of them, over sqrt(g r_0)
  seed = 1
  delta = 0.0                            # of the cell in which a wave saturates
  floor = 0.05                           # 1/s, the least ||V|| there
  saturation = [{ epsilon = 1e-4, cells = [32, 64, 128, 256] }]

While a march runs, OUTPUT.checkpoint holds what it has reached, and is removed once the result is written. A march that
was interrupted or killed goes on by stability resume OUTPUT.checkpoint, or by the same stability run again, and ends
with the same fields to the last bit. stability export OUTPUT --vtk FOLDER writes them for ParaView.

What a scene names (matrix, sampling, accuracy) is taken even where it misses the tolerance: a warning then says so. The
plan, its reasons, and the predicted and true error are attributes of the result; stability explain SCENE shows the plan
alone.
"""

DERIVE = """\
Derive the tangent matrix of CLOSURE and print it in the paper's letters.

full is D (L3.1, P3), truncated is D' (P7), leading is M (P4). xi_x and xi_y are the components of the wavevector. A
letter with one index more is a derivative: u_y is du/dy, A_xx_y is dA_xx/dy. Where a closure declares no letters, the
entries of its moduli are called m_0, m_1, ...

CLOSURE is a name of stability list closures, or that of a closure in a file of your own, which is then executed:

\b
  stability derive my_file.py:MY_CLOSURE
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

Of a march it says how many elements and unknowns there are, how many cells lie in a wavelength of the first waves, and
about how many steps and seconds it takes.
"""

RESUME = """\
Go on from CHECKPOINT with the march that wrote it, by the scene that it holds; write the result and print a summary.

A march keeps OUTPUT.checkpoint while it runs. Whatever stopped it, the file is that of its last checkpoint, or, where
Newton's method failed, of its last good state. The result is that of a run that was never stopped, to the last bit, on
the same machine with the same versions; with others the checkpoint is refused.

\b
  stability resume N1.nc.checkpoint                        writes N1.nc; a file.py:NAME in the scene is looked for here
  stability resume N1.nc.checkpoint --scene N1-fine.toml   goes on with other steps, scheme, floor, solver or tolerance,
                                                           or to a later time; the result says so
"""

EXPORT = """\
Write RESULT for ParaView: the snapshots of a march, a structured grid (.vts) each, and their times (.pvd); or a field
map, on the grid (.vts) or the cells (.vtu) of the file that its scene names.

\b
  stability export N1.nc --vtk N1-vtk        then open N1-vtk/N1.pvd
  stability export map.nc --vtk maps --scene scenes/map.toml

The fields of a march are the velocity (Cartesian, m/s), its components along and across the rays, pressure (m2/s2),
||V|| (1/s), delta and mu (m2/s), on the mesh's polar grid in the plane z = 0.
"""
