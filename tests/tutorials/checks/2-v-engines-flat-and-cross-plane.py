# %% after cell-03
assert list(table.kg.round(2)) == [9, 7, 7]

# %% after cell-05
assert round(flat[2].force.peak, 4) == 23.2559
assert round(flat[4].force.peak, 4) == round(cross[4].force.peak, 4) == 1.6686
assert list(cross[1].moment.peak_xy.round(4)) == [2.7915, 2.7915]
assert list(cross[2].moment.peak_xy.round(4)) == [0, 1.1628]

# %% after cell-10
built = table.loc[["0-90-270-180", "0-270-90-180"]]
assert np.allclose(built["1× pitch"], table["1× pitch"].max())
assert (built[["2× pitch", "2× yaw"]] == 0).all(axis=None)

# %% after cell-12
assert str(couple.peak) == "sqrt(10)*F*a"
assert as_built.closed_form(2).peak == 0

# %% after cell-17
assert np.allclose((arc**2).sum(axis=1), (listed**2).sum())
assert round((listed**2).sum() ** 0.5 / 4.111, 3) == round(2**0.5, 3)

# %% after cell-21
assert str(three.closed_form(1).peak) == "sqrt(3)*F*a"
assert list(straight.round(3)) == [1.709, 0.712]
assert (np.hypot(*(total - [1.710, 0.711]).T) > 0.05).all()

# %% after cell-23
assert all(b[order].force.peak == 0 for order in (1, 2, 4))
assert b[6].force.peak > 0.1

# %% after cell-25
assert abs(ratio - 11 / 9) < 1e-12

# %% after cell-27
assert round(naive[1.5], 1) == 18.7

# %% after cell-29
inertia = still.waveform(3000, theta_deg=theta).force @ [1, 1j]
assert abs(on_block - inertia).max() < 1e-9
assert b[1.5].force.peak == b[1.5].torque.peak == 0
assert b[4].force.peak == still.balance(3000)[4].force.peak
