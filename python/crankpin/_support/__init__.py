"""Inputs, tables and other tools that know nothing of engines."""
