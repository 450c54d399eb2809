"""All arrangements of the throws of a crank, and those whose moment a counterweight cancels.

``cranks`` a crank and its mirror images, ``throw_orders`` all orders of its throws →
``shared_pins`` and ``search`` the arrangements of a vee.
"""
