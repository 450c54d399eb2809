"""Analyses of engines: one question, one function, one result a file."""
