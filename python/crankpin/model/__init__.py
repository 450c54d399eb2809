"""Engines: cylinders, shafts, layouts, presets, files."""
