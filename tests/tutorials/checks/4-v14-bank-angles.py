# %% after cell-03
assert (round(abs(z1), 6), round(abs(z2), 6)) == (2.019044, 2.019044)
assert np.rad2deg(np.angle(-z2 / z1)).round(2) == 49.54

# %% after cell-07
assert (search.candidates, search.qualifying, len(search)) == (254_016, 12_936, 218)
assert search.candidates == 504**2

# %% after cell-09
assert [round(found.bank_angle_deg, 2) for found in best[:2]] == [9.13, 170.87]

# %% after cell-11
assert (table.against == 0).all()
for case, amplitude, phase in (("49.54", 1.5363, "51.43"), ("63.03", 4.9216, "38.57")):
    assert table.loc[(case, "paper"), "A"].round(4) == amplitude
    assert table.loc[(case, "paper"), "θ₀"] == phase
assert round(yaw / pitch, 2) == 1.13
larger = table.loc[("49.54", "paper"), "2nd yaw"]
assert 5 < larger / yaw < larger / pitch < 6

# %% after cell-14
smaller = ["–", "pitch, yaw", "pitch", "–", "pitch, yaw"]
assert table["smaller than the V-6's"].to_list() == smaller

# %% after cell-16
assert len(set(nearest)) == len(printed) == 216
assert list(missing.round(2)) == [90.91, 152.87]

# %% after cell-17
assert ((60 * gaps.max()).round(1), (60 * gaps.min()).round(1)) == (176.4, 8.9)

# %% after cell-19
assert list(table.loc["=="]) == ["2544", "3384", "1992", "1992"]
assert table.loc["1e-06", "single"] == "7640"
assert (12_936 % 14, 7_682 % 14) == (0, 10)
magnitudes = np.unique(squares(None, float).round(9))
assert np.diff(magnitudes).min().round(2) == 0.34

# %% after cell-21
assert (other[:, None] == other).sum() == 2526

# %% after cell-23
TABLE = {
    5: (8, 0.46, 2e-15),
    7: (171, 2.0e-3, 7.2e-15),
    9: (7761, 3.0e-5, 1.1e-14),
    11: (883320, 4.3e-9, 3e-14),
}
for throws, (magnitudes, least, rounding) in TABLE.items():
    apart = distances(throws, np.float64)
    different = apart > 1e-10
    assert different.sum() + 1 == magnitudes
    assert float(f"{apart[different].min():.1e}") == least
    assert apart[~different].max() <= rounding

# %% after cell-26
assert sorted(pairs) == [28] * 210 + [504] * 2 + [1008] * 6
assert counts == {
    "begins elsewhere": [854, 1706],
    "… or has the other sign": [428, 854],
    "… or runs backward": [338, 674],
}
