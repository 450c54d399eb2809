# %% after cell-03
PRINTED = {
    ("single", "F 1×"): 9.87,
    ("single", "F 2×"): 4.11,
    ("i4", "F 2×"): 16.44,
    ("i4", "F 4×"): 1.18,
    ("i3", "M 1×"): 1.71,
    ("i3", "M 2×"): 0.71,
    ("i3", "M 4×"): 0.05,
    ("flat-4", "M 1×"): 3.95,
}
assert all(round(frame.loc[cell], 2) == figure for cell, figure in PRINTED.items())
assert round(frame.loc[("single", "F 4×")], 5) == 0.29497

# %% after cell-07
assert rows["boxer-4"] == ["–", "–"]
assert rows["i6"] == ["6×", "–"]
assert 6 not in cp.Engine.preset("v12-60").vanishing_orders().force.vanishing

# %% after cell-09
assert np.isclose(b[6].force.peak, 6 * 7 * abs(a6) * (np.pi / 3) ** 2)
assert round(b[6].force.peak / frame.loc[("i4", "F 2×")], 3) == 0.009

# %% after cell-13
assert list(seven[2].round(2)) == [23.39, 16.44, 10.54, 7.80]

# %% after cell-15
range_of_engines = 100 * (np.interp([0.25, 0.33], lam, exact / lam) - 1)
assert list(range_of_engines.round(1)) == [1.6, 2.9]
assert (seven[0, 0] / seven[0, 2]).round(2) == 2.22

# %% after cell-20
assert hum[0] == 0
assert np.isclose(hum[1], 4 * delta * 7 * a2 * (np.pi / 3) ** 2)
