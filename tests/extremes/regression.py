"""The file of every sample on which a path of the toolkit ever failed, and how to add one.

An entry has the family, the question (closure, flow, parameters, point, wave), ``sign`` and ``value`` of the leading
growth rate to 40 digits, ``failed`` (which path, and what it gave) and ``fixed_by``.
"""

import json
from pathlib import Path

import numpy as np

from tests.extremes import truth
from tests.extremes.case import Case

FILE = Path(__file__).with_name("regression.json")
FIELDS = ("family", "closure", "flow", "parameters", "point")


def load() -> list[dict]:
    """Return the entries."""
    return json.loads(FILE.read_text(encoding="utf-8"))


def case_of(entry: dict) -> Case:
    """Return the one wave of an entry."""
    angle, q = np.array([entry["wave_angle"]]), np.array([entry["wavenumber"]])
    return Case(*(entry[f] for f in FIELDS), angle, q)


def entry_of(case: Case, i: int, j: int, failed: str, fixed_by: str) -> dict:
    """Return the entry of a sample, with its truth."""
    alone = case.wave(i, j)
    ball = truth.by_balls(alone)[0][0]
    return {f: getattr(case, f) for f in FIELDS} | {
        "wave_angle": float(alone.wave_angle[0]),
        "wavenumber": float(alone.wavenumber[0]),
        "sign": 1 if ball > 0 else -1 if ball < 0 else 0,
        "value": ball.str(40, radius=False),
        "failed": failed,
        "fixed_by": fixed_by,
    }


def add(*entries: dict) -> None:
    """Append entries to the file; a sample is kept once."""
    kept = load() if FILE.exists() else []
    known = {json.dumps([e[f] for f in (*FIELDS, "wave_angle", "wavenumber")]) for e in kept}
    kept += [e for e in entries if json.dumps([e[f] for f in (*FIELDS, "wave_angle", "wavenumber")]) not in known]
    FILE.write_text("[\n" + ",\n".join(json.dumps(e) for e in kept) + "\n]\n", encoding="utf-8")
