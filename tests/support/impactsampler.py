"""Impacts drawn from what is known of them, by importance sampling: the judge of draws and bounds.

An impact is nine numbers: six velocities before, e, e_m and P_t/P_n; the prior is flat over those
that physics allows, every known value multiplies it by its own density, normal ones cut off at
three standard deviations. The proposals are mixtures of Student's t, fitted to the weighted draws
of the round before while the density hardens. Nothing here is shared with the package: the impact
is solved by `routh.impulse`, everything else is written out below.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from routh import impulse

BEFORE = ("UX", "UY", "WA", "VX", "VY", "WB")
AFTER = ("VAX", "VAY", "WAF", "VBX", "VBY", "WBF")
SIGMAS = 3.0
LARGEST_FRICTION = 10.0
WIDER, MORE = 0.2, 0.1  # how much the limits of friction are widened: of their distance, and at all


@dataclass(frozen=True)
class Known:
    """One known value: ``kind`` exact, uniform or normal, with its two numbers."""

    kind: str
    first: float
    second: float = 0.0

    def text(self) -> str:
        if self.kind == "exact":
            return repr(self.first)
        if self.kind == "uniform":
            return f"{self.first!r} .. {self.second!r}"
        return f"normal {self.first!r} {self.second!r}"

    @property
    def ends(self) -> tuple[float, float]:
        if self.kind == "normal":
            reach = SIGMAS * self.second
            return self.first - reach, self.first + reach
        return self.first, self.second

    def drawn(self, rng, count):
        if self.kind == "uniform":
            return rng.uniform(self.first, self.second, count)
        values = rng.standard_normal(count)
        while (beyond := np.abs(values) > SIGMAS).any():
            values[beyond] = rng.standard_normal(beyond.sum())
        return self.first + self.second * values


def exact(value):
    return Known("exact", value)


@np.errstate(all="ignore")
def impact(scene, mu):
    """Every quantity of impacts with signed P_t/P_n ``mu``, and the limits of what friction can
    make, before they are widened (``low``, ``high``)."""
    g = {name: np.asarray(value, float) for name, value in scene.items()}
    pn, pt, gn, gt, turning, yielding = impulse(g, mu)
    c, s = np.cos(np.radians(g["GA"])), np.sin(np.radians(g["GA"]))
    px, py = pn * c - pt * s, pn * s + pt * c
    own = {**g, "PN": pn, "PT": pt, "MUP": mu, "VC": -gn, "gt": gt}
    own["VAX"], own["VAY"] = g["UX"] + px / g["MA"], g["UY"] + py / g["MA"]
    own["VBX"], own["VBY"] = g["VX"] - px / g["MB"], g["VY"] - py / g["MB"]
    alpha, beta = np.radians(g["TA"] + g["PA"]), np.radians(g["TB"] + g["PB"])
    ax, ay = -g["DA"] * np.cos(alpha), -g["DA"] * np.sin(alpha)
    bx, by = g["DB"] * np.cos(beta), g["DB"] * np.sin(beta)
    # the moment impulse: Equation 18, from the spins that the impulse alone would leave
    wa = g["WA"] + (ax * py - ay * px) / g["IA"]
    wb = g["WB"] - (bx * py - by * px) / g["IB"]
    inverse = 1 / g["IA"] + 1 / g["IB"]
    moment = -(1 - g["EM"]) * (wa - wb) / ((1 - 2 * g["EM"]) * inverse)
    own["PM"], own["WAF"], own["WBF"] = moment, wa + moment / g["IA"], wb - moment / g["IB"]
    for name, x, y in (("SA", "UX", "UY"), ("SB", "VX", "VY"), ("SAF", "VAX", "VAY")):
        own[name] = np.hypot(own[x], own[y])
    own["SBF"] = np.hypot(own["VBX"], own["VBY"])
    for name, x, y in (("HA", "UX", "UY"), ("HB", "VX", "VY"), ("HAF", "VAX", "VAY")):
        own[name] = np.degrees(np.arctan2(own[y], own[x]))
    own["HBF"] = np.degrees(np.arctan2(own["VBY"], own["VBX"]))
    size = np.hypot(pn, pt)
    own["DVA"], own["DVB"] = size / g["MA"], size / g["MB"]
    facing = np.radians(g["TB"])
    own["DVBF"] = (-px * np.cos(facing) - py * np.sin(facing)) / g["MB"]
    own["PDOFA"] = g["TA"] - np.degrees(np.arctan2(py, px))

    def energy(six):
        a = g["MA"] * (own[six[0]] ** 2 + own[six[1]] ** 2) + g["IA"] * own[six[2]] ** 2
        b = g["MB"] * (own[six[3]] ** 2 + own[six[4]] ** 2) + g["IB"] * own[six[5]] ** 2
        return (a + b) / 2

    own["KI"], own["KF"] = energy(BEFORE), energy(AFTER)
    own["EL"] = own["KI"] - own["KF"]
    own["LOSS"] = 100 * own["EL"] / own["KI"]
    pivot_pn, pivot_pt, *_ = impulse(g, np.full(np.shape(mu), np.nan))
    critical = np.where(pivot_pn > 0, pivot_pt / pivot_pn, np.sign(pivot_pt) * np.inf)
    largest = (np.sqrt(2 * np.abs(gt * turning) / pn) - np.abs(turning)) ** 2
    largest = largest / (np.abs(turning) * yielding)
    ratio = np.abs(gt) / (np.abs(turning) * pn)
    reverses = (gt * turning < 0) & (ratio > 0.5) & (ratio < 2)
    back = np.where(reverses, -np.sign(gt) * largest, 0.0)
    own["MUC"] = critical
    own["low"] = np.minimum(np.minimum(critical, back), 0.0)
    own["high"] = np.maximum(np.maximum(critical, back), 0.0)
    return own


def possible(own, given):
    """True for each impact that physics allows; ``given``: the coefficients that are given, which
    are not judged."""
    ok = (own["VC"] > 0) & (own["PN"] > 0) & (own["EL"] >= 0)
    if "E" not in given:
        ok &= (own["E"] >= 0) & (own["E"] <= 1)
    if "EM" not in given:
        ok &= (own["EM"] >= -1) & (own["EM"] <= 0)
    if "MUP" not in given:
        room = WIDER * (own["high"] - own["low"]) + MORE
        low, high = own["low"] - room, own["high"] + room
        ok &= own["MUP"] >= np.maximum(low, -LARGEST_FRICTION)
        ok &= own["MUP"] <= np.minimum(high, LARGEST_FRICTION)
    return ok


@np.errstate(all="ignore")
def weights(log, beyond, ok, log_proposal, hardness=math.inf):
    """Importance weights of points, limits softened."""
    if math.isinf(hardness):
        soft = np.where(ok & (beyond == 0), log, -np.inf) - log_proposal
    else:
        soft = np.where(ok, log - hardness * beyond, -np.inf) - log_proposal
    return np.nan_to_num(np.exp(soft - soft.max()))


def effective(w):
    return float(w.sum() ** 2 / (np.square(w).sum() or 1))


class Problem:
    """What is known, by name; ``truth``: the nine numbers of a true impact, to start from."""

    def __init__(self, known, truth):
        self.known, self.truth = known, truth
        self.fixed = {n: v.first for n, v in known.items() if v.kind == "exact"}
        self.open = [n for n in (*BEFORE, "E", "EM", "MUP") if n not in self.fixed]
        self.given = [n for n in ("E", "EM", "MUP") if n in known]
        unusable = [n for n in self.fixed if n not in self.truth and n[0] not in "DGPTMI"]
        assert not unusable, unusable

    def impacts(self, theta):
        """Impacts at points (open numbers, n)."""
        values = {**self.fixed, **dict(zip(self.open, theta, strict=True))}
        values = {n: np.broadcast_to(v, theta.shape[1]) for n, v in values.items()}
        mu = values.pop("MUP")
        return impact(values, mu)

    @np.errstate(all="ignore")
    def terms(self, theta):
        """Impacts; log density inside the limits; how far all limits are exceeded, 0 inside; True
        where physics allows the impact."""
        own = self.impacts(theta)
        log, beyond = np.zeros(theta.shape[1]), np.zeros(theta.shape[1])
        for name, item in self.known.items():
            if item.kind == "exact":
                continue
            value, (low, high) = own[name], item.ends
            if name in ("HA", "HB", "HAF", "HBF", "PDOFA"):
                value = value - 360 * np.round((value - (low + high) / 2) / 360)
            middle, half = (low + high) / 2, (high - low) / 2
            off = np.abs(value - middle) / half
            beyond += np.maximum(off - 1, 0) ** 2
            if item.kind == "normal":
                log += -0.5 * (SIGMAS * np.minimum(off, 1)) ** 2
        ok = possible(own, self.given) & np.isfinite(log) & np.isfinite(beyond)
        return own, np.where(np.isfinite(log), log, -np.inf), beyond, ok

    def sample(self, count, rng, rounds=40, size=40_000, components=10):
        """Impacts, their weights and the effective number of them."""
        start = np.array([self.truth[n] for n in self.open])
        spread = [{"E": 0.2, "EM": 0.3, "MUP": 0.4, "WA": 1, "WB": 1}.get(n, 25) for n in self.open]
        mixture = [(1.0, start, np.diag(np.square(np.array(spread, float))))]
        hardness = 0.0
        for _ in range(rounds):
            theta, log_proposal = self._propose(mixture, size, rng)
            _, log, beyond, ok = self.terms(theta)

            parts = log, beyond, ok, log_proposal
            if effective(weights(*parts, math.inf)) > size / 20:
                break
            low, high = math.log(hardness + 1e-3), math.log(hardness + 1e-3) + 6
            for _ in range(25):
                middle = (low + high) / 2
                enough = effective(weights(*parts, math.exp(middle))) > size / 40
                low, high = (middle, high) if enough else (low, middle)
            hardness = math.exp(low)
            mixture = self._fit(theta, weights(*parts, hardness), components, rng)
        for _ in range(3):
            mixture = self._fit(theta, weights(log, beyond, ok, log_proposal), components, rng)
            theta, log_proposal = self._propose(mixture, size, rng)
            _, log, beyond, ok = self.terms(theta)
        theta, log_proposal = self._propose(mixture, count, rng)
        own, log, beyond, ok = self.terms(theta)
        w = weights(log, beyond, ok, log_proposal)
        return own, w, effective(w)

    def _propose(self, mixture, count, rng, freedom=5.0):
        fractions = np.array([f for f, _, _ in mixture])
        numbers = rng.multinomial(count, fractions / fractions.sum())
        parts, size = [], len(self.open)
        for number, (_, center, covariance) in zip(numbers, mixture, strict=True):
            root = np.linalg.cholesky(covariance)
            steps = root @ rng.standard_normal((size, number))
            parts.append(
                center[:, None] + steps / np.sqrt(rng.chisquare(freedom, number) / freedom)
            )
        theta = np.concatenate(parts, axis=1)
        logs = []
        for fraction, center, covariance in mixture:
            root = np.linalg.cholesky(covariance)
            away = np.linalg.solve(root, theta - center[:, None])
            square = np.square(away).sum(axis=0)
            log = -(freedom + size) / 2 * np.log1p(square / freedom)
            logs.append(log - np.log(np.diag(root)).sum() + np.log(fraction / fractions.sum()))
        return theta, np.logaddexp.reduce(logs, axis=0)

    def _fit(self, theta, w, components, rng):
        """A mixture fitted to weighted points: k means, then the spread about each, widened."""
        number = min(8000, theta.shape[1] // 2)
        chosen = theta[:, rng.choice(theta.shape[1], number, p=w / w.sum())]
        scale = chosen.std(axis=1, keepdims=True) + 1e-12
        points = (chosen / scale).T
        points = points + 1e-3 * rng.standard_normal(points.shape)
        centers = points[rng.integers(len(points), size=components)]
        for _ in range(15):
            nearest = np.square(points[:, None] - centers).sum(axis=2).argmin(axis=1)
            centers = np.array(
                [
                    points[nearest == k].mean(axis=0) if (nearest == k).any() else centers[k]
                    for k in range(components)
                ]
            )
        mixture, whole = [], np.cov(points.T).reshape(len(scale), len(scale))
        for k in range(components):
            own = points[nearest == k]
            if len(own) < 5 * len(scale):
                continue
            covariance = 1.6 * np.cov(own.T).reshape(whole.shape) + 0.02 * whole
            covariance += 1e-6 * np.eye(len(scale))
            covariance = covariance * np.outer(scale, scale)
            mixture.append((len(own) / len(points), centers[k] * scale[:, 0], covariance))
        mixture.append((0.1, points.mean(axis=0) * scale[:, 0], 3 * whole * np.outer(scale, scale)))
        return mixture


def quantiles(values, weights, fractions):
    """Weighted quantiles."""
    order = np.argsort(values)
    sums = np.cumsum(weights[order])
    return np.interp(np.array(fractions) * sums[-1], sums, values[order])


VEHICLE = {"DA": (3, 8), "DB": (3, 8), "MA": (70, 150), "MB": (70, 150)}
KINDS = ("after", "skid", "change", "energy", "spins")


def problem(kind, seed, friction=None):
    """A fresh problem: a true impact that physics strictly allows, measured with noise.

    ``friction``: True where P_t/P_n is given within limits; by default at random."""
    rng = np.random.default_rng([seed, KINDS.index(kind)])
    while True:
        scene = {n: rng.uniform(*ends) for n, ends in VEHICLE.items()}
        scene |= {"IA": scene["MA"] * rng.uniform(16, 30), "IB": scene["MB"] * rng.uniform(16, 30)}
        scene |= {"TA": rng.uniform(-15, 15), "PA": rng.uniform(150, 210)}
        scene |= {"TB": rng.uniform(40, 140), "PB": rng.uniform(-180, 180), "GA": 180.0}
        scene["GA"] += rng.uniform(-40, 40)
        scene |= {"UX": rng.uniform(25, 70), "UY": rng.normal(0, 3)}
        heading, speed = math.radians(scene["TB"]), rng.uniform(10, 50)
        scene |= {"VX": speed * math.cos(heading), "VY": speed * math.sin(heading)}
        scene |= {"WA": 0.0, "WB": 0.0, "E": rng.uniform(0, 0.3), "EM": rng.uniform(-0.9, -0.1)}
        mu = np.array([rng.uniform(-0.8, 0.8)])
        own = impact({n: np.array([v]) for n, v in scene.items()}, mu)
        inside = (mu >= own["low"]) & (mu <= own["high"])
        if bool((possible(own, ()) & inside)[0]) and own["VC"][0] > 8:
            break
    truth = {n: float(np.ravel(v)[0]) for n, v in own.items()}
    known = {n: exact(scene[n]) for n in (*VEHICLE, "IA", "IB", "TA", "PA", "TB", "PB", "GA")}
    known |= {"WA": exact(0.0), "WB": exact(0.0)}

    def measured(name, deviation):
        known[name] = Known("normal", float(truth[name] + deviation * _cut(rng)), deviation)

    known["E"], known["EM"] = Known("uniform", 0.0, 0.3), Known("uniform", -0.9, -0.1)
    if kind == "after":
        for name, deviation in (("SAF", 1.5), ("HAF", 3.0), ("SBF", 1.5), ("HBF", 3.0)):
            measured(name, deviation)
        measured("UY", 1.0)
        measured("DVB", 1.5)
    elif kind == "skid":
        for name, deviation in (("HA", 2.0), ("HB", 2.0), ("SAF", 2.0), ("HAF", 5.0)):
            measured(name, deviation)
        for name, deviation in (("SBF", 2.0), ("HBF", 5.0)):
            measured(name, deviation)
    elif kind == "change":
        for name, deviation in (("DVA", 1.0), ("PDOFA", 8.0), ("SB", 3.0), ("HB", 3.0)):
            measured(name, deviation)
        measured("UY", 2.0)
        measured("VC", 3.0)
    elif kind == "energy":
        for name, deviation in (("EL", 0.15 * truth["EL"]), ("VAX", 2.0), ("VAY", 2.0)):
            measured(name, deviation)
        for name, deviation in (("SBF", 2.0), ("HB", 3.0), ("UY", 1.5)):
            measured(name, deviation)
    else:
        for name in ("VAX", "VAY", "VBX", "VBY"):
            measured(name, 1.5)
        measured("WAF", 0.3)
        measured("WBF", 0.3)
        del known["E"], known["EM"]
        measured("UY", 1.5)
    given = rng.random() < 0.5 if friction is None else friction
    if given:
        low = truth["MUP"] - rng.uniform(0.05, 0.25)
        known["MUP"] = Known("uniform", low, low + 0.3)
    return Problem(known, {**truth, "MUP": float(mu[0])})


def _cut(rng):
    while abs(value := rng.standard_normal()) > SIGMAS:
        pass
    return value
