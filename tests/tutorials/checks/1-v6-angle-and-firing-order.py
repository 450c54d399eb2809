# %% after cell-10
assert printed.size == 272
assert len(wrong) == 3
assert (printed[1, 2, 0], printed[2, 10, 1], printed[2, 14, 1]) == (2065.36, 589.81, 2065.36)

# %% after cell-12
assert at_160_180[0, 0].round(2) == printed[2, 15, 0] == 1348.06
assert at_160_180[1, 0] == 0

# %% after cell-18
for order, angle in zip(ORDERS, (90, 30, 150, 90), strict=True):
    first = v6[order].with_bank_angle(angle, hold="pins").balance(5000, orders=[1])[1].moment
    assert 0 in (first.forward, first.backward)

# %% after cell-20
assert [best[order] for order in ORDERS] == [(90,), (60,), (120,), (90,)]

# %% after cell-26
assert best_peak[ORDERS[3]] == best_left[ORDERS[3]] == (10,)
assert best_left[ORDERS[0]] == (90,)
for order, two in ((ORDERS[1], (60, 30)), (ORDERS[2], (120, 150))):
    papers, other = (table.loc[(order, angle), columns] for angle in two)
    assert (papers > other).all()

# %% after cell-28
turned = (
    (order, v6[order].with_bank_angle(angle, hold="pins"))
    for order in ORDERS
    for angle in range(1, 181)
)
assert not any(firing.even for order, engine in turned for firing in engine.firing_schedules(order))

# %% after cell-33
assert b[1].moment.backward == 0
assert b[2].moment.forward == 0

# %% after cell-35
assert round(exact, 3) == 1.021

# %% after cell-37
assert round(b[6].force.peak) == 14
assert round(m_r * (2 * np.pi * 5000 / 60) ** 2, -3) == 18000
assert all(b[order].force.peak == 0 for order in (1, 2, 4))
