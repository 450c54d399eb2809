"""Inverse design: cranks, pin splits, bank angles and balancers that minimise objectives.

``question`` the request → ``families`` all candidates and their engines → ``optima`` angles that
vary, by the core's objectives with derivatives → ``designs`` the result. ``unlike`` the masses,
places and throws of unlike cylinders that are to be chosen → ``vanishing`` their values.
"""
