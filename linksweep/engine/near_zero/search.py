"""Find where signals come near to zero around the turn, and where they are zero, for several designs side by side.

Each lane has a design. Its turn is divided into pieces; signals are sampled on one piece after the other, and brackets
opened about dips (`dips.py`) and zeros (`crossings.py`), which are then refined together.

`find_near_zero` is plain Python that is translated to machine code.
"""

from linksweep.engine.kernel.instructions import call
from linksweep.engine.near_zero.crossings import find_zeros, look_for_crossings
from linksweep.engine.near_zero.dips import check_noise, look_for_dips, measure_widths, open_sides, refine_dips
from linksweep.engine.near_zero.places import NOTES, note_crossings, note_dips
from linksweep.engine.near_zero.samples import AT, place_samples


def find_near_zero(
    first, last, designs, lanes, sizes, parameters, parameter_at, grades, prepare, share, sample, evaluate, constants,
    x, rows, ends, kinds, near, beyond, dips, dipped, crossings, crossed, events, left
):  # fmt: skip
    """Write the events in blocks `first` … `last` of designs to `events`, and 1 to `left` of designs that are left.

    The plan has three signals for each of the `kinds`: the signal, its opposite, and its upper bound, as far as
    noise goes. `near` and `beyond` are tables for the places at which it comes near to zero, and crosses it.
    """
    own, signals, results = constants[0], len(kinds), (events, left)
    places, columns = len(x) // (2 * lanes), 3 * signals * lanes
    for block in range(first, last):
        front = block * lanes
        call(prepare, (front, designs, sizes, parameters, parameter_at, own))
        used = min(lanes, designs - front)
        for lane in range(lanes):
            dipped[lane], crossed[lane] = 0, 0
        for nth in range(ends.shape[2] - 1):
            pieces = 0
            for lane in range(used):
                pieces += place_samples(ends, front + lane, nth, lanes, lane, places, grades, x)
            if pieces > 0:
                call(sample, (own, x, rows))
                note_dips(rows, places - 1, columns, near)
                note_crossings(rows[2 * signals * lanes :], places - 1, columns, beyond)
                for lane in range(used):
                    if ends[AT, front + lane, nth + 1] == ends[AT, front + lane, nth + 1]:
                        samples, half = (rows, x, places, columns, lanes, lane), x[places * lanes + lane]
                        for signal in range(signals):
                            kind, owner, k = kinds[signal], front + lane, signal * lanes + lane
                            look_for_dips(
                                samples, near[NOTES, k], half, signal, signals, kind, dips, dipped, owner, results
                            )
                            look_for_crossings(
                                samples, beyond[NOTES, k], half, signal, signals, crossings, crossed, owner, results
                            )
        refine_dips(dips, dipped, lanes, own, evaluate)
        check_noise(dips, dipped, lanes, signals, own, evaluate, front, results)
        open_sides(dips, dipped, lanes, signals, kinds, crossings, crossed, front, results)
        measure_widths(dips, dipped, lanes, own, evaluate, front, results)
        find_zeros(crossings, crossed, lanes, own, evaluate, front, results)
