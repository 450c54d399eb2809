"""Balancing hardware and the residual: counterweights, bob weights and balance shafts.

``planes`` where weights can be, and parts that turn → ``fitting``, ``fitted_shafts`` weights that
remove the most → ``counterweights``, ``bob_weight``, ``two_plane``, ``balance_shafts`` one question
each → ``balancer_options`` all sets of them.
"""
