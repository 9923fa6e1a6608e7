"""Balance of moving masses: shaking moment, orders, regressor, counterweights, comparison before and after.

Their functions are public; reports and the command line import from here.
"""
