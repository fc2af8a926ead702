"""What the tests share: the paper's hopper, the reference numbers, a cache of generated modules of their own."""

import json
import os
from pathlib import Path

import pytest
from mpmath import mp

# The paper prints the two angles of friction; the rest is the project's stated assumption.
HOPPER = {
    "friction_angle": 34,
    "wall_friction_angle": 9,
    "wedge_angle": 15,
    "outlet_radius": 0.5,
    "inlet_radius": 1.5,
    "gravity": 9.81,
}


def pytest_configure(config: pytest.Config) -> None:
    os.environ["STABILITY_CACHE"] = str(config.cache.mkdir("generated"))  # never the user's


@pytest.fixture(autouse=True)
def sixty_digits():
    """Expected decimals are read with more digits than any of them has."""
    with mp.workdps(60):
        yield


@pytest.fixture
def hopper() -> dict:
    return dict(HOPPER)


@pytest.fixture
def perturbed_hopper() -> dict:
    return HOPPER | {"epsilon": 2e-5}


@pytest.fixture(scope="session")
def reference() -> dict:
    """Eigenvalues to 40 digits, by two independent routes; the file says how."""
    return json.loads((Path(__file__).parent / "reference" / "eigenvalues.json").read_text())
