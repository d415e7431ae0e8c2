"""Every kind of scene side by side, and the comparison of results bit by bit."""

import numpy as np

from impact88.bench.populations import scenes
from impact88.mechanics.closedform.columns import UNUSED_BY_POINTS


def same(a, b):
    """The same bits: the sign of a zero counts, and so does which NaN it is."""
    a, b = (np.ascontiguousarray(x, np.float64).view(np.uint64) for x in (a, b))
    return a == b


def mixed_scenes(count=4000, seed=5):
    """Every kind of scene side by side, some of them unusable."""
    rng = np.random.default_rng(seed)
    g = scenes("casework", count, seed)

    def sometimes(share, value, name):
        return np.where(rng.random(count) < share, value, g[name])

    g["MU"], g["M"] = sometimes(0.2, -10.0, "MU"), sometimes(0.2, 4.0, "M")
    for name in ("DA", "DB", "GA", "WA", "WB", "MU", "EM", "E", "UX", "VY"):
        g[name] = sometimes(0.15, 0.0, name)
        g[name] = sometimes(0.05, -0.0, name)
    g["EM"] = sometimes(0.1, 1.0, "EM")
    rest = rng.random(count) < 0.05
    for name in ("UX", "UY", "VX", "VY", "WA", "WB"):
        g[name] = np.where(rest, rng.choice([0.0, -0.0], count), g[name])
    wall = rng.random(count) < 0.1
    for name in ("MB", "IB"):
        g[name] = np.where(wall, np.inf, g[name])
    for name in ("VX", "VY", "WB"):
        g[name] = np.where(wall, 0.0, g[name])
    g["UX"], g["IA"] = sometimes(0.05, np.nan, "UX"), sometimes(0.03, -1.0, "IA")
    g["TA"], g["M"] = sometimes(0.03, 1e12, "TA"), sometimes(0.02, 5.0, "M")
    for name in UNUSED_BY_POINTS:
        anything = rng.choice([np.nan, np.inf, -1.0, 1e300], count)
        g[name] = np.where((g["M"] == 4) & (rng.random(count) < 0.3), anything, g[name])
    return g
