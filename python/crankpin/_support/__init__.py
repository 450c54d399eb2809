"""Inputs, tables and other tools independent of engines."""
