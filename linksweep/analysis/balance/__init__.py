"""Answer what shakes: orders, counterweights, regressor, comparison before and after."""
