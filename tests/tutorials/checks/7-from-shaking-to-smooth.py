# %% after cell-03
assert bob.straight_line_factors("force") == ((0, 90), (1, 0))
assert np.isclose(bob.fitted.balance(RPM)[1].force.peak, one / 2)
assert round(bob.grams[0]) == 225

# %% after cell-05
assert np.round(rolls).tolist() == [25, 383, 25]
assert forces == [0, 0]

# %% after cell-07
assert np.allclose(list(left.values()), one * np.cos(np.deg2rad(list(left))))
assert 1 in ninety.fitted.vanishing_orders([1]).force.vanishing

# %% after cell-09
assert aside == [30, 330]
assert np.isclose(moments[1], moments[0] / 2)
assert moments[2] < 1e-9 * moments[0]

# %% after cell-11
assert round(second["none"].force.peak, -2) == 9300
assert all(second[name].force.peak < 1e-6 for name in ("level", "right", "exchanged"))
assert np.allclose(roll, [1, 1, 0, 2])
assert round(1000 * apart) == 142

# %% after cell-14
assert [round(e.balance(RPM).total.moment.peak) for e in steps.values()] == [2101, 823, 503]

# %% after cell-16
assert options.smallest.name == "counterweights + shaft −2"
assert options.smallest.values[0] < 0.01 * options[0].values[0]

# %% after cell-18
assert fitted.vanishes
assert alike.vanishes
assert np.isclose(v8.balance(RPM)[1].moment.peak, 10**0.5 * one * 0.1)
assert (round(fitted.largest * 1000, 1), round(alike.largest * 1000, 1)) == (10.2, 7.6)

# %% after cell-20
share = over.fitted.balance(RPM)[1].moment.peak / v8.balance(RPM)[1].moment.peak
assert np.isclose(share, 0.04)

# %% after cell-22
assert (even[0].bank_angle_deg, smooth[0].bank_angle_deg) == (72, 90)
assert even[0].throws_deg == (0, 144, 216, 288, 72)
assert smooth[0].value == 0

# %% after cell-24
assert made.nominal[1].force.peak == 0
assert round(typical) == 228
assert big_ends.values[0] > 50  # %
assert pistons.values[1] > 50

# %% after cell-26
assert match.exact
assert round(match.initial_value / match.value, 1) == 4.6
