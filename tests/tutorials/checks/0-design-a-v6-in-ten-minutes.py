# %% after cell-03
assert round(litres, 2) == 3.00

# %% after cell-05
assert sixty.fires_evenly

# %% after cell-14
assert balance[1].moment.backward == 0
assert balance[2].moment.forward == 0
assert balance.total.force.peak < 10

# %% after cell-16
assert list(angles[sweep[1].moment.backward == 0]) == [60]

# %% after cell-18
assert [choice.name for choice in ranking][:2] == ["V6 60°, split -60°", "V6 90°, split -30°"]
assert round(ranking[1].values[1]) == 400

# %% after cell-21
assert np.round(amounts, 5).tolist() == [0.01218, 0.00326]

# %% after cell-24
first = [engine.balance(RPM, orders=[1])[1].moment.peak for engine in (ninety, smooth)]
assert first[1] < 1e-9 * first[0]  # rounding: weights and shaft are found in floats

# %% after cell-26
assert peaks["60°, counterweights"] < peaks["90°, counterweights and shaft"]

# %% after cell-28
assert again == smooth

# %% after cell-30
assert round(left, 1) == 9.3
assert left < 0.01 * balance.total.moment.peak
assert smoothest.balance(RPM)[4].moment.peak > 0.99 * left
