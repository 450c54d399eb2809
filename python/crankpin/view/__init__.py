"""Engines that turn: a page that needs a browser alone, and a widget for notebooks."""
