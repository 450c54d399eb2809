"""Engines in order of what they shake: objectives, local optima between bank angles, ties."""
