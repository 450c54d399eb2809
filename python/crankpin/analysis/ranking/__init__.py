"""Ranking of engines: objectives, local optima between bank angles, ties."""
