"""Inverse design: cranks, pin splits, bank angles and balancers that minimise objectives.

``question`` what is asked → ``cranks`` a candidate and its mirror images → ``families`` all
candidates → ``phasors``, ``merit`` their loads with derivatives → ``optima`` the continuous parts →
``built`` engines, with counterweights and shafts → ``designs`` the result.
"""
