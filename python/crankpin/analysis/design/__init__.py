"""Inverse design: cranks, pin splits, bank angles and balancers that minimise objectives.

``question`` what is asked → ``families`` all
candidates → ``phasors``, ``merit`` their loads with derivatives → ``optima`` the continuous parts →
``built`` engines, with counterweights and shafts → ``designs`` the result.
"""
