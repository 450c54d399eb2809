# %% after cell-05
assert not b.force.xy[[0, 1, 3]].any()
assert not b.moment.xy[1:].any()

# %% after cell-07
assert str(couple.forward_magnitude) == "sqrt(10)*F*a"
assert couple.backward == 0
assert np.isclose(float(couple.forward_phase) - np.pi, -np.pi / 4 - np.arctan(3))
assert np.isclose(couple.evaluate(3000)["forward"], b[1].moment.forward)

# %% after cell-09
assert vanishing.moment.vanishing == tuple(range(2, 25))

# %% after cell-11
assert np.ptp(radius) < 1e-14 * radius.mean()

# %% after cell-13
assert np.isclose(
    amount, 10**0.5 * 0.1 * cylinder.reciprocating_mass * cylinder.crank_radius / apart
)
assert fitted.vanishes
assert abs(fitted.fitted.waveform(3000).moment).max() < 1e-12 * radius.mean()
assert round(mass, 3) == 0.356

# %% after cell-15
assert str(force.y) == "4*sqrt(2)*F"
assert force.x == 0

# %% after cell-17
assert abs(w.force[:, 0]).max() < 1e-9

# %% after cell-21
assert firing.even
assert firing.gaps()[0][5, 7] == 90.0

# %% after cell-24
assert (other.pin_split_deg != 0).all()
assert first.moment.forward == 0
