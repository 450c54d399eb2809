# %% after cell-05
assert np.isclose(mean, cycle.work(cylinder) / (4 * np.pi), rtol=1e-12)

# %% after cell-09
assert 3000 < quiet < 6000

# %% after cell-11
assert cp.star_diagram(i4).major == (2, 4, 6, 8, 10, 12)

# %% after cell-13
assert even[0.5].crank_torque.status == "zero, proved"
assert np.isclose(uneven.crank_torque.cycle_mean, 0.75 * even.crank_torque.cycle_mean)

# %% after cell-17
for rpm in (3000, 6000):
    gas, both = cp.flywheel(i4, rpm=rpm, inertia=0.15).errors
    assert abs(both) < 0.1 * abs(gas)

# %% after cell-19
assert inertias["single"] > inertias["i4"] > inertias["v12-60"]

# %% after cell-21
assert idle.irregularity < full.irregularity
