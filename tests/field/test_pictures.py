"""Pictures of field maps: their data, never their pixels."""

import numpy as np
from matplotlib.figure import Figure

from stability.field.grids import field_from
from stability.field.mapping import field_map
from stability.field.pictures import COLOURS, field_growth, field_verdicts
from tests.field.fields import hopper


def test_verdict_and_growth_are_drawn_side_by_side_on_grids_and_points():
    grid = hopper(12)[0]
    points = field_from(grid.x.ravel(), grid.y.ravel(), **{n: a.ravel() for n, a in grid.values.items()})
    for field in (grid, points):
        ds = field_map("rigid_plastic", field, {"friction_angle": 34}, duration=0.01, check=False)
        left, right = Figure(figsize=(7, 3.5)).subplots(1, 2)
        drawn = field_verdicts(ds, left)
        assert np.unique(drawn.get_array()).tolist() == [4] and len(left.get_legend().legend_handles) == 1
        growth = field_growth(ds, right, [1, 10, 100])
        expected = np.digitize(ds.grid_e_folds.values, [1, 10, 100])
        assert np.array_equal(np.asarray(growth.get_array()).ravel(), expected.ravel())
        assert right.get_xlabel() == "$x$ (m)"
    assert len(set(COLOURS)) == 6
