"""Effect of tolerances on an engine, and matching of measured parts.

``spreads`` how parts vary → ``arrays`` their influences → ``samples`` the result of
``tolerances``; ``matching`` measured parts to cylinders → ``match_parts``.
"""
