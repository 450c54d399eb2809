"""What to fit so that an engine shakes less, and what stays: counterweights and balance shafts.

``planes`` and ``first_order`` what unit weights do → ``fitting``, ``least_weights``,
``fitted_shafts`` the weights that remove the most → ``counterweights``, ``bob_weight``,
``two_plane``, ``balance_shafts`` one question each → ``balancer_options`` all sets of them.
"""
