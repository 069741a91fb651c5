"""Rays through graded media by the classical Runge-Kutta method of order four, compiled by numba.

graded_numba.py CLOAKROOM prints JSON: for the Luneburg lens and the double-Gaussian cloak the rays a second of
CPU time, on one core, at the largest step whose error stays below 1e-6 cm, and that error.

With dr = p dσ and n² known, the equations of motion are dp/dσ = ∇(n²)/2, d(optical path)/dσ = n². For the cloak
x + iy = f(ζ) and n = 1/|f'|, so ∇n² = -2 n² conj(f''/f'²), and ζ follows from Newton's method at each
evaluation (`physical`). In virtual space (`virtual`), with τ the optical path and p_z constant,
dζ/dτ = P, dP/dτ = -p_z² f' conj(f''), dz/dτ = p_z |f'|²; that is what a careful author would integrate.

The rays are those of crates/cloakroom/benches/devices.rs. Errors are those of the place and the optical
path at the last point of the device: for the lens against the closed form, for the cloak against `cloakroom
trace` with a tolerance of 1e-10 cm, which a much shorter step must confirm. Reflections of a few ten
thousandths at the cloak's cut are left out here; cloakroom follows them.
"""

import json
import math
import subprocess
import sys
import tempfile
import time

import numpy as np
from numba import njit

RAYS = 256
TOLERANCE = 1e-6
RADIUS = 10.0
WIDTH, HEIGHT = 10.02, 4.25
X_MAX, Y_MAX = 25.0, 28.57
ROTATION = math.radians(10)

PHYSICAL, VIRTUAL, LUNEBURG = 0, 1, 2
INSIDE, OUT, METAL = 0, 1, 2

# Weideman's expansion of the Faddeeva function, SIAM J. Numer. Anal. 31, 1497 (1994), good to 4e-14.
TERMS = 32
SCALE = math.sqrt(TERMS / math.sqrt(2))


def weideman():
    half = 2 * TERMS
    angle = np.arange(-half + 1, half) * np.pi / half
    t = SCALE * np.tan(angle / 2)
    values = np.concatenate(([0.0], np.exp(-t * t) * (SCALE**2 + t * t)))
    spectrum = np.real(np.fft.fft(np.fft.fftshift(values))) / (2 * half)
    return np.ascontiguousarray(np.flipud(spectrum[1 : TERMS + 1]))


COEFFICIENTS = weideman()


@njit(fastmath=False)
def jet(zeta):
    """f, f' and f'' of the Gaussian map."""
    t = zeta / WIDTH
    below = SCALE - 1j * t
    ratio = (SCALE + 1j * t) / below
    sum_ = 0j
    for c in COEFFICIENTS:
        sum_ = sum_ * ratio + c
    w = 2 * sum_ / (below * below) + (1 / math.sqrt(math.pi)) / below
    w1 = -2 * t * w + 2j / math.sqrt(math.pi)
    w2 = -2 * w - 2 * t * w1
    slope = 1j * HEIGHT / WIDTH
    return zeta + 1j * HEIGHT * w, 1 + slope * w1, slope / WIDTH * w2


@njit
def inverse(z, zeta):
    """ζ at x + iy, from a first guess."""
    for _ in range(50):
        f, f1, _ = jet(zeta)
        move = (z - f) / f1
        zeta += move
        if abs(move) < 1e-13:
            break
    return zeta


@njit
def rates(kind, y, guess, out):
    """dy/ds, y = (position, momentum, optical path); the new guess of ζ."""
    if kind == LUNEBURG:
        for i in range(3):
            out[i], out[3 + i] = y[3 + i], -y[i] / (RADIUS * RADIUS)
        out[6] = 2 - (y[0] * y[0] + y[1] * y[1] + y[2] * y[2]) / (RADIUS * RADIUS)
    elif kind == PHYSICAL:
        guess = inverse(complex(y[0], y[1]), guess)
        _, f1, f2 = jet(guess)
        square = 1 / (f1.real**2 + f1.imag**2)
        force = -square * (f2 / (f1 * f1)).conjugate()
        out[0], out[1], out[2] = y[3], y[4], y[5]
        out[3], out[4], out[5], out[6] = force.real, force.imag, 0.0, square
    else:
        _, f1, f2 = jet(complex(y[0], y[1]))
        force = -y[5] * y[5] * f1 * f2.conjugate()
        out[0], out[1], out[2] = y[3], y[4], y[5] * (f1.real**2 + f1.imag**2)
        out[3], out[4], out[5], out[6] = force.real, force.imag, 0.0, 1.0
    return guess


@njit
def step(kind, y, h, guess, k, stage, out):
    guess = rates(kind, y, guess, k[0])
    for i in range(7):
        stage[i] = y[i] + 0.5 * h * k[0, i]
    guess = rates(kind, stage, guess, k[1])
    for i in range(7):
        stage[i] = y[i] + 0.5 * h * k[1, i]
    guess = rates(kind, stage, guess, k[2])
    for i in range(7):
        stage[i] = y[i] + h * k[2, i]
    guess = rates(kind, stage, guess, k[3])
    for i in range(7):
        out[i] = y[i] + h / 6 * (k[0, i] + 2 * k[1, i] + 2 * k[2, i] + k[3, i])
    return guess


@njit
def gauge(kind, which, y, guess):
    """How far inside the border a point is: the radius; the floor, or the cut."""
    if kind == LUNEBURG:
        return RADIUS - math.sqrt(y[0] ** 2 + y[1] ** 2 + y[2] ** 2)
    if kind == VIRTUAL:
        zeta = complex(y[0], y[1])
        if which == 0:
            return zeta.imag
        z, _, _ = jet(zeta)
    else:
        z = complex(y[0], y[1])
        if which == 0:
            return inverse(z, guess).imag
    if which == 1:
        return z.real + X_MAX
    if which == 2:
        return X_MAX - z.real
    return Y_MAX - z.imag


@njit
def advance(kind, y, h, guess, work):
    """Steps to the border: y is then there. Which part of it."""
    k, stage, out, trial = work[0:4], work[4], work[5], work[6]
    parts = 1 if kind == LUNEBURG else 4
    for _ in range(1000000):
        new_guess = step(kind, y, h, guess, k, stage, out)
        least, found = h, -1
        for which in range(parts):
            b, gb = h, gauge(kind, which, out, new_guess)
            if gb >= 0:
                continue
            # The crossing, by the Illinois variant of regula falsi on the length of the step.
            a, ga = 0.0, max(gauge(kind, which, y, guess), 0.0)
            for _ in range(60):
                c = b - gb * (b - a) / (gb - ga)
                trial_guess = step(kind, y, c, guess, k, stage, trial)
                gc = gauge(kind, which, trial, trial_guess)
                if gc * gb < 0:
                    a, ga = b, gb
                else:
                    ga *= 0.5
                b, gb = c, gc
                if abs(gc) < 1e-13:
                    break
            if b <= least:
                least, found = b, which
        if found >= 0:
            guess = step(kind, y, least, guess, k, stage, trial)
            for i in range(7):
                y[i] = trial[i]
            return found, guess
        for i in range(7):
            y[i] = out[i]
        guess = new_guess
    return -1, guess


@njit
def through_lens(origin, direction, h, result, work):
    """Place and optical path at the exit of the Luneburg lens; whether the ray meets it."""
    half = -(origin @ direction)
    under = half * half - origin @ origin + RADIUS * RADIUS
    if under <= 0:
        return False
    y = work[7]
    distance = half - math.sqrt(under)
    y[0:3] = origin + direction * distance
    y[3:6] = direction
    y[6] = distance
    advance(LUNEBURG, y, h * RADIUS, 0j, work)
    result[0:3], result[3] = y[0:3], y[6]
    return True


@njit
def through_cloak(kind, origin, direction, h, result, work):
    """Place and optical path at the exit of the cloak; whether the ray goes through it."""
    # The face where it comes in: that which is met last of those that face it.
    distance, face = -1.0, 0
    for i, limit in ((0, X_MAX), (1, Y_MAX)):
        s = (-math.copysign(limit, direction[i]) - origin[i]) / direction[i]
        if s > distance:
            distance, face = s, i
    at = origin + direction * distance
    if abs(at[0]) > X_MAX + 1e-9 or abs(at[1]) > Y_MAX + 1e-9:
        return False
    side = math.copysign(1.0, at[1])
    z = complex(at[0], abs(at[1]))
    zeta = inverse(z, z + HEIGHT * WIDTH / (math.sqrt(math.pi) * z))
    if zeta.imag <= 0:
        return False
    _, f1, _ = jet(zeta)
    square = 1 / (f1.real**2 + f1.imag**2)
    inward = np.array([direction[0], side * direction[1], direction[2]])
    normal = math.copysign(math.sqrt(square - 1 + inward[face] ** 2), inward[face])
    inward[face] = normal
    y = work[7]
    if kind == VIRTUAL:
        momentum = f1.conjugate() * complex(inward[0], inward[1])
        y[0], y[1], y[3], y[4] = zeta.real, zeta.imag, momentum.real, momentum.imag
    else:
        y[0], y[1], y[3], y[4] = z.real, z.imag, inward[0], inward[1]
    y[2], y[5], y[6] = at[2], inward[2], distance
    for _ in range(8):
        found, zeta = advance(kind, y, h * WIDTH, zeta, work)
        if found != 0:
            break
        # The mirror: P -> conj(P), p in physical space likewise about the tangent f'.
        if kind == VIRTUAL:
            y[4] = -y[4]
        else:
            _, f1, _ = jet(zeta)
            p = complex(y[3], y[4])
            p = f1 / f1.conjugate() * p.conjugate()
            y[3], y[4] = p.real, p.imag
    if kind == VIRTUAL:
        f, _, _ = jet(complex(y[0], y[1]))
        result[0], result[1] = f.real, side * f.imag
    else:
        result[0], result[1] = y[0], side * y[1]
    result[2], result[3] = y[2], y[6]
    return True


@njit
def trace(kind, origins, directions, h, results, hit):
    work = np.zeros((8, 7))
    for i in range(len(origins)):
        if kind == LUNEBURG:
            hit[i] = through_lens(origins[i], directions[i], h, results[i], work)
        else:
            hit[i] = through_cloak(kind, origins[i], directions[i], h, results[i], work)


def launches():
    """Origins and directions of the bench's rays, in the world."""
    n = np.arange(RAYS)
    block, member = n // 4, n % 4

    def place(by, following):
        return 16 * ((block * by) % 1 - 0.5) + 0.03 * following

    y = place(0.7548776662466928, member // 2)
    z = place(0.5698402909980533, member % 2)
    directions = np.stack([np.full(RAYS, 100.0), y, z], axis=1)
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    return np.tile([-100.0, 0.0, 0.0], (RAYS, 1)), directions


def turned(vectors, angle):
    c, s = math.cos(angle), math.sin(angle)
    x, y, z = vectors.T
    return np.ascontiguousarray(np.stack([c * x - s * y, s * x + c * y, z], axis=1))


def run(kind, origins, directions, h):
    results, hit = np.full((RAYS, 4), np.nan), np.zeros(RAYS, dtype=bool)
    trace(kind, origins, directions, h, results, hit)
    return results, hit


def error(results, exact, hit):
    return float(np.abs(results - exact)[hit].max())


def rate(kind, origins, directions, h):
    rates = []
    for _ in range(5):
        start, rays = time.process_time(), 0
        while time.process_time() < start + 0.3:
            run(kind, origins, directions, h)
            rays += RAYS
        rates.append(rays / (time.process_time() - start))
    return float(np.median(rates))


def measured(kind, origins, directions, exact):
    """Rate and error with the longest of the steps 2^(-k/2) that is good enough."""
    for k in range(40):
        h = 2 ** (-k / 2)
        results, hit = run(kind, origins, directions, h)
        off = error(results, exact, hit)
        if off <= TOLERANCE:
            rays_per_second = rate(kind, origins, directions, h)
            return {"rays_per_cpu_second": rays_per_second, "error_cm": off, "step": h}, h
    raise SystemExit("no step is short enough")


def closed_form(origins, directions):
    """The exit of the Luneburg lens and the optical path to it."""
    half = -np.einsum("ij,ij->i", origins, directions)
    with np.errstate(invalid="ignore"):
        root = np.sqrt(half**2 - np.einsum("ij,ij->i", origins, origins) + RADIUS**2)
    entry = origins + directions * (half - root)[:, None]
    optical_path = half - root + RADIUS * (math.pi / 2 + root / RADIUS)
    return np.column_stack([directions * RADIUS, optical_path]), entry


def from_cloakroom(cloakroom, origins, directions):
    """Where cloakroom has the strongest leaf of each ray leave the cloak."""
    rays = [
        {"origin": o, "direction": d} for o, d in zip(origins.tolist(), directions.tolist())
    ]
    with tempfile.NamedTemporaryFile("w", suffix=".toml") as scene:
        scene.write('[[device]]\nkind = "double-gaussian-cloak"\nrotation = 10\n')
        scene.flush()
        # `trace` gives the optical path to the exit.
        command = [cloakroom, "trace", scene.name, "--set", "trace.tolerance=1e-10", "--rays", "-"]
        done = subprocess.run(command, input=json.dumps(rays), capture_output=True, text=True)
    done.check_returncode()
    strongest = [
        max(report["leaves"], key=lambda leaf: leaf["power"]) for report in json.loads(done.stdout)
    ]
    places = np.array([leaf["position"] for leaf in strongest])
    return np.column_stack(
        [turned(places, -ROTATION), [leaf["optical_path"] for leaf in strongest]]
    )


def main():
    origins, directions = launches()
    table = {}
    exact, _ = closed_form(origins, directions)
    table["Luneburg lens"], _ = measured(LUNEBURG, origins, directions, exact)

    here = turned(origins, -ROTATION), turned(directions, -ROTATION)
    exact = from_cloakroom(sys.argv[1], origins, directions)
    for name, kind in (("physical", PHYSICAL), ("virtual", VIRTUAL)):
        table[f"design (iv), {name} space"], h = measured(kind, *here, exact)
    fine, hit = run(VIRTUAL, *here, h / 16)
    table["design (iv), virtual space"]["sixteenth_of_the_step_off_cloakroom_cm"] = error(
        fine, exact, hit
    )
    print(json.dumps(table, indent=1))


main()
