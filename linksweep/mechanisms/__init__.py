"""Which machines there are: each a frozen dataclass and a table of what can be computed of it."""

from linksweep.mechanisms.four_bar import FourBar
from linksweep.mechanisms.slider_crank import SliderCrank

Mechanism = FourBar | SliderCrank
MECHANISMS = (FourBar, SliderCrank)
