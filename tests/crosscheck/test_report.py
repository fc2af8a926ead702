"""The whole cross-check as a Dataset, its tables and its figure, at a reduced size."""

import json

import numpy as np
import pytest

from stability.crosscheck.report import PARTS, crosscheck
from stability.crosscheck.tables import VARIABLES, markdown
from stability.crosscheck.waves import Wave
from stability.errors import SceneError
from stability.results import open_results, save
from tests.conftest import HOPPER

POINT = {"r": 1.0, "theta": 0.0}
SMALL = {
    "chosen": (Wave(91.6, 40.0, 0.0, 1e-4), Wave(91.6, 15.0, 0.0, 1e-4)),
    "states": ((0.0, 1e-4),),
    "elements": 400,
    "symbol_elements": (1000, 4000, 16000),
    "duration": 0.006,
    "courses": ((4e-4, (16,)), (4e-3, (16, 24))),
    "cells": (12, 24),
    "numbers": (3, 6),
}


@pytest.fixture(scope="module")
def told():
    return []


@pytest.fixture(scope="module")
def ds(told):
    given = HOPPER | {"epsilon": 4e-4}
    return crosscheck("perturbed", "radial_hopper", given, POINT, progress=lambda *said: told.append(said), **SMALL)


def test_every_variable_has_its_unit_and_meaning(ds):
    assert set(ds.variables) == set(VARIABLES)
    assert all(ds[name].attrs == dict(zip(("units", "long_name"), VARIABLES[name], strict=True)) for name in VARIABLES)


def test_parts_are_told_in_order_with_the_work_done(ds, told):
    assert [note for _, _, note in told] == list(PARTS)
    done = [d for d, _, _ in told]
    assert done == sorted(done) and all(d < total for d, total, _ in told)


def test_cell_has_strain_rate_and_pressure_of_the_point(ds):
    cell = json.loads(ds.attrs["cell_parameters"])
    assert set(cell) == {"friction_angle", "strain_rate", "pressure"}
    assert abs(cell["strain_rate"] - 2.092868095057769) < 1e-12  # published with the project's conventions, ||V||(1, 0)


def test_result_survives_saving(ds, tmp_path):
    again = open_results(save(ds, tmp_path / "X1.nc"))
    assert again.identical(ds)


def test_markdown_has_a_table_for_each_part_and_no_number_missing(ds):
    text = markdown(ds)
    assert text.count("| --- |") >= 5 and text.count("## ") == 5
    assert "nan" not in text and "{" not in text
    rows = [line for line in text.splitlines() if line.startswith("| ")]
    assert len(rows) == 2 * 5 + 2 + 1 + (3 + 1) + 6 + 3  # heads with their rules, waves, ray, meshes, ways, courses


def test_parts_can_be_had_alone():
    given = HOPPER | {"epsilon": 1e-4}
    alone = crosscheck("perturbed", "radial_hopper", given, POINT, parts=("symbol",), symbol_elements=(1000, 4000))
    assert all(name.startswith("symbol_") for name in alone.variables)
    assert "## The discrete symbol" in markdown(alone) and markdown(alone).count("## ") == 1


def test_unknown_parts_are_refused():
    with pytest.raises(SceneError, match="parts = \\['cells'\\] are unknown: use some of cell, neutral"):
        crosscheck("perturbed", "radial_hopper", HOPPER | {"epsilon": 1e-4}, POINT, parts=("cells",))


def test_figure_is_drawn_from_the_result_and_says_what_is_measured(ds):
    from figures import X1

    figure, caption = X1.draw(lambda name: ds)
    assert len(figure.axes) == 7 and "{" not in caption and "friction angle = 34 deg" in caption
    worst = 100 * float(ds.cell_error.max())
    assert f"largest: {worst:.2g} %" in " ".join(caption.split())
    assert np.isfinite(worst)
