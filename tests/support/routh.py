"""A judge of friction: which tangential impulses Coulomb's friction can leave, by Routh's process.

It follows the impact as it goes on. The normal impulse p grows from 0 to the scene's Pn, the moment
impulse in proportion to it, and the tangential one, q, as friction makes it: against the sliding
while there is any, as much as keeps the points together where friction suffices for that, else
against the sliding that follows. Over all coefficients of friction the final q form an interval; an
impact outside it is none that friction can make. Nothing here is shared with the package.
"""

from __future__ import annotations

import numpy as np


def impulse(scene, mu):
    """Pn, Pt and the moment impulse on A of scenes (name -> array), with the signed P_t/P_n ``mu``
    (NaN: no slip at separation), from three equations a scene; and the terms of the slip along t:
    at the beginning, by each unit of Pn and of Pt."""
    g = {name: np.asarray(value, np.float64) for name, value in scene.items()}
    gamma, alpha, beta = (
        np.radians(g[first] + (g[second] if second else 0.0))
        for first, second in (("GA", ""), ("TA", "PA"), ("TB", "PB"))
    )
    n, t = (np.cos(gamma), np.sin(gamma)), (-np.sin(gamma), np.cos(gamma))
    # from each center to the contact point; a spin w moves a point at (x, y) by (-w y, w x)
    arms = []
    for d, angle, side in ((g["DA"], alpha, -1.0), (g["DB"], beta, 1.0)):
        d = np.where(g.get("M", 6.0) == 4, 0.0, d)
        x, y = side * d * np.cos(angle), side * d * np.sin(angle)
        arms.append([x * axis[1] - y * axis[0] for axis in (n, t)])
    (an, at), (bn, bt) = arms
    ma, mb, ia, ib = (1 / g[name] for name in ("MA", "MB", "IA", "IB"))
    ux, uy, wa, wb = g["UX"] - g["VX"], g["UY"] - g["VY"], g["WA"], g["WB"]
    gn = n[0] * ux + n[1] * uy + an * wa - bn * wb
    gt = t[0] * ux + t[1] * uy + at * wa - bt * wb
    nn = ma + mb + ia * an**2 + ib * bn**2
    nt = ia * an * at + ib * bn * bt
    tt = ma + mb + ia * at**2 + ib * bt**2
    mn, mt = ia * an + ib * bn, ia * at + ib * bt  # by a moment impulse on A, its reaction on B
    em, free = g["EM"], np.isnan(mu)
    one, zero = np.ones_like(gn), np.zeros_like(gn)
    slip = [np.where(free, nt, -np.where(free, 0, mu)), np.where(free, tt, 1.0)]
    rows = [
        [nn * one, nt * one, mn * one],
        [*slip, np.where(free, mt, 0.0)],
        [(1 - em) * mn, (1 - em) * mt, (1 - 2 * em) * (ia + ib) * one],
    ]
    right = [-(1 + g["E"]) * gn, np.where(free, -gt, 0.0), (em - 1) * (wa - wb)]
    matrix = np.stack([np.stack(np.broadcast_arrays(*row), -1) for row in rows], -2)
    solved = np.linalg.solve(matrix, np.stack(np.broadcast_arrays(*right, zero)[:3], -1)[..., None])
    pn, pt, moment = np.moveaxis(solved[..., 0], -1, 0)
    return pn, pt, gn, gt, nt + mt * moment / pn, tt


def final(mu, gt, K, tt, pn):
    """The tangential impulse after the process with a coefficient ``mu`` >= 0."""
    sign = np.where(gt == 0, np.sign(K), np.sign(gt))
    slowing = mu * tt - sign * K
    p1 = np.where(gt == 0, np.where(slowing > 0, 0.0, np.inf), np.abs(gt) / slowing)
    slides_on = (slowing <= 0) | (p1 >= pn)
    sticks = mu * tt >= np.abs(K)
    back = sign * mu * (pn - 2 * p1)
    return np.where(slides_on, -sign * mu * pn, np.where(sticks, -(gt + K * pn) / tt, back))


def possible(gt, K, tt, pn):
    """Lowest and highest tangential impulse over all coefficients: at none, at the one that just
    ends the sliding at separation, at those where sticking begins, and where sliding forth and back
    makes most of it."""
    size = np.abs(K)
    candidates = [
        np.zeros_like(gt),
        np.maximum((np.abs(gt) / pn + np.sign(gt) * K) / tt, 0.0),
        size / tt,
        np.clip((np.sqrt(2 * np.abs(gt) * size / pn) - size) / tt, 0.0, size / tt),
        (size + np.abs(gt) / pn) / tt * 4.0 + 1.0,
    ]
    every = [final(mu, gt, K, tt, pn) for mu in candidates]
    return np.min(every, axis=0), np.max(every, axis=0)


@np.errstate(all="ignore")
def judged(scene, mu):
    """(whether the points approach and push, whether friction can make the impact), for scenes with
    the signed P_t/P_n ``mu``."""
    pn, pt, gn, gt, K, tt = impulse(scene, np.asarray(mu, np.float64))
    low, high = possible(gt, K, tt, pn)
    slack = 1e-9 * np.abs(pn)
    return (gn < 0) & (pn > 0), (pt >= low - slack) & (pt <= high + slack)
