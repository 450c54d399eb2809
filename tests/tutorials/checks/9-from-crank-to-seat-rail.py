# %% after cell-03
assert balance.orders[:3] == (2, 4, 6)
assert np.isclose(balance[2].torque.gas.peak, i4.balance(3000)[2].torque.gas.peak)
assert round(balance[2].force.peak) == 165
assert round(i4.balance(6000)[2].force.peak, -3) == 9000

# %% after cell-05
assert [k + 1 for k in range(6) if modes.purity[k] < 90] == [1, 6]
assert modes.dominant[0] == "lateral"
assert modes.dominant[5] == "roll"

# %% after cell-07
assert worst.order == 2
assert abs(worst.order * worst.rpm / 60 - worst.mode_frequency) < 0.2
assert modes.frequency.max() < 2 * IDLE / 60

# %% after cell-08
assert not np.any(run_up.wrench[..., 0])  # no sideways force of the engine's own
moved = run_up[2].motion[-1, 1] * 148 * (2 * 2 * np.pi * 3000 / 60) ** 2
assert np.isclose(abs(moved), abs(run_up[2].wrench[-1, 1]), rtol=0.1)  # a free body

# %% after cell-10
assert all(modes.frequency.min() < order * IDLE / 60 < modes.frequency.max() for order in (0.5, 1))
assert whole[0.5].body_force.peak == 0

# %% after cell-12
assert 0.9 < ratio < 1.1
assert felt[2].rms[speeds == IDLE] > 0.99 * felt.total.rms[speeds == IDLE]
assert road < 0.05 * idle_rock.body_force.total.peak

# %% after cell-14
assert np.allclose(robust.frequency_bounds[1], np.sqrt(1.15) * robust.frequency)
assert (robust.least_purity < 0.6 * robust.purity).sum() == 5

# %% after cell-16
assert gain[1] < 0.1 * gain[0]
assert design.after[0] < design.before[0]

# %% after cell-17
assert after[0] < 0.1 * before[0]
assert sag[1] > 2 * sag[0]

# %% after cell-19
for computed, closed in rows.values():
    assert np.isclose(computed, closed, rtol=1e-9)

# %% after cell-21
assert quiet < 1e-9
assert elsewhere > 1
assert share < 1

# %% after cell-23
assert strain.columns[4].values[4] == max(column.values[4] for column in strain.columns[2:])
assert fifth[1] < fifth[0]
assert per_roll[1] < 0.5 * per_roll[0]
assert np.isclose(abs(1 - np.exp(1j * np.radians(degrees))), 0.1)
