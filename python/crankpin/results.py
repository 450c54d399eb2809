"""Classes of results, for annotations and ``isinstance``; functions and engines make them."""

from crankpin._support import lazy

__all__, __getattr__, __dir__ = lazy.attach(__name__, __file__)
