"""Amplitude coefficients of the interface from air to a uniaxial dielectric with a tilted axis, by pyElli:
sets (all four reflection and four transmission coefficients) a second of CPU time."""

import json
import time

import elli
import numpy as np
from elli.utils import rotation_euler

SETS = 4096
ORDINARY, EXTRAORDINARY = 1.5382, 1.8088
INCIDENCE_DEG = 27.1

crystal = elli.UniaxialMaterial(
    elli.ConstantRefractiveIndex(ORDINARY), elli.ConstantRefractiveIndex(EXTRAORDINARY)
)
crystal.set_rotation(rotation_euler(0.4, 0.9, 0.2))
structure = elli.Structure(elli.AIR, [], crystal)
# pyElli works on all wavelengths of a list at once; without dispersion each is the same problem again.
wavelengths = np.linspace(400, 800, SETS)


def solve():
    result = structure.evaluate(wavelengths, INCIDENCE_DEG, solver=elli.Solver4x4)
    return result.jones_matrix_r, result.jones_matrix_t


rates = []
for _ in range(8):
    start = time.process_time()
    reflected, _ = solve()
    rates.append(SETS / (time.process_time() - start))
print(json.dumps({"sets_per_cpu_second": float(np.median(rates)), "r": str(reflected[0].tolist())}))
