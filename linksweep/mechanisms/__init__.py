"""The machines: each a frozen dataclass, and a table of the quantities that can be computed of it.

To add one, see `Mechanism`: derive from it and `register` the class.
"""

from linksweep.mechanisms.four_bar import FourBar
from linksweep.mechanisms.inverted_slider_crank import InvertedSliderCrank
from linksweep.mechanisms.linkage import Linkage
from linksweep.mechanisms.loop_track import LoopTrack
from linksweep.mechanisms.mechanism import MECHANISMS, Mechanism, indices, register
from linksweep.mechanisms.slider_crank import SliderCrank

__all__ = [
    "MECHANISMS",
    "FourBar",
    "InvertedSliderCrank",
    "Linkage",
    "LoopTrack",
    "Mechanism",
    "SliderCrank",
    "indices",
    "register",
]
