"""Which machines there are: each a frozen dataclass and a table of what can be computed of it."""

from linksweep.mechanisms.four_bar import FourBar
from linksweep.mechanisms.inverted_slider_crank import InvertedSliderCrank
from linksweep.mechanisms.loop_track import LoopTrack
from linksweep.mechanisms.slider_crank import SliderCrank

Mechanism = FourBar | SliderCrank | InvertedSliderCrank | LoopTrack
MECHANISMS = (FourBar, SliderCrank, InvertedSliderCrank, LoopTrack)
INDICES = tuple(dict.fromkeys(kind.index for kind in MECHANISMS))
"""What a sweep's own dimension may be called."""
