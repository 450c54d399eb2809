"""Inverse design: cranks, pin splits, bank angles and balancers that minimise objectives.

``question`` what is asked → ``families`` all candidates → ``optima`` the angles that vary, by the
core's objectives with derivatives → ``built`` engines, with counterweights and shafts → ``designs``
the result.
"""
