from linksweep.plot.balancing import balance as balance
from linksweep.plot.beams import moment_diagram as moment_diagram
from linksweep.plot.beams import moment_diagrams as moment_diagrams
from linksweep.plot.curves import forces as forces
from linksweep.plot.curves import torque as torque
from linksweep.plot.cycle_page import cycle as cycle
from linksweep.plot.drives import flywheel as flywheel
from linksweep.plot.drives import motor_load as motor_load
from linksweep.plot.drives import run_up as run_up
from linksweep.plot.drives import steady_cycle as steady_cycle
from linksweep.plot.drives import torque_with_flywheel as torque_with_flywheel
from linksweep.plot.films.animation import animate as animate
from linksweep.plot.heat_maps import heat_map as heat_map
from linksweep.plot.load_analysis import breakdown as breakdown
from linksweep.plot.load_analysis import over_speed as over_speed
from linksweep.plot.load_diagrams import bearing as bearing
from linksweep.plot.load_diagrams import bearings as bearings
from linksweep.plot.machine import mechanism as mechanism
from linksweep.plot.shaking_force import hodograph as hodograph
from linksweep.plot.shaking_force import orders as orders
from linksweep.plot.study_plots import parallel_coordinates as parallel_coordinates
from linksweep.plot.study_plots import scatter as scatter
from linksweep.plot.tolerances import tornado as tornado
from linksweep.plot.track import loop as loop

__all__ = [
    "animate",
    "balance",
    "bearing",
    "bearings",
    "breakdown",
    "cycle",
    "flywheel",
    "forces",
    "heat_map",
    "hodograph",
    "loop",
    "mechanism",
    "moment_diagram",
    "moment_diagrams",
    "motor_load",
    "orders",
    "over_speed",
    "parallel_coordinates",
    "run_up",
    "scatter",
    "steady_cycle",
    "tornado",
    "torque",
    "torque_with_flywheel",
]
