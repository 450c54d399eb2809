"""Fixtures of the core in a browser."""

from core_in_page import ask, page

__all__ = ["ask", "page"]
