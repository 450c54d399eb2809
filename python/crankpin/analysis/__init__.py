"""Analyses of engines: one question, one function and one result per file."""
