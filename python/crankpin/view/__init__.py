"""Turning engines: a self-contained page for browsers, and a widget for notebooks."""
