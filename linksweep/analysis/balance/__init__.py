"""Balance of moving masses: shaking moment, orders, regressor, counterweights, comparison before and after."""
