"""What spreads of parts do to an engine, and which parts to put together.

``spreads`` how parts vary → ``arrays`` their influences → ``samples`` the result of
``tolerances``; ``matching`` measured parts to cylinders → ``match_parts``.
"""
