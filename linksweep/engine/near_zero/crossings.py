"""Find the zeros of signals between samples on pieces of a turn, and flat places where there may be more of them.

Where a signal crosses zero with hardly any slope, there may be three zeros in the place of one, as where a toggle joint
is just stretched when it turns round. Such a flat place is noted: another look, with samples dense about it, shows.

All is plain Python that is translated to machine code.

Source: Dowell and Jarratt, A modified regula falsi method, BIT 11 (1971).
"""

from linksweep.engine.kernel.instructions import call
from linksweep.engine.near_zero.places import next_place
from linksweep.engine.near_zero.samples import MOST, SPARE, note, place, sample, upper_bound, used_columns
from linksweep.engine.peaks.zeros import (
    AT_TRIAL,
    HOLDS,
    OPEN,
    SETTLED,
    SIDE,
    SIGNAL_NUMBER,
    STEPS,
    STOP,
    TRIAL,
    narrow,
    open_zero,
    place_on_lines,
)

SLIGHT = 0.5
"""Least slope, relative to that between the samples on both sides of a zero, up to which there may be three."""
FLAT = 1e-3
"""Half-width that is noted of a flat place: three zeros in a tenth of a degree may be taken as one."""


def look_for_crossings(samples, noted, half, signal, signals, crossings, counts, owner, results):
    """Open brackets of a signal's zeros about places on a piece, and note flat places; what may be noise counts as
    positive, and so does a sample without a value, which no bracket spans."""
    places = samples[2]
    for step in range(places - 2 * SPARE):
        if noted < 1.0:
            break
        j, noted = next_place(noted, step)
        inside = SPARE < j < places - SPARE
        if inside and is_negative(samples, j, signal, signals) != is_negative(samples, j - 1, signal, signals):
            i, k = j - 1, j
            while i > 0 and may_be_noise(samples, i, signal, signals):
                i -= 1
            while k < places - 1 and may_be_noise(samples, k, signal, signals):
                k += 1
            f_i, f_k = sample(samples, i, signal), sample(samples, k, signal)
            if f_i * f_k < 0.0:
                bracket = place(samples, i), f_i, place(samples, k), f_k
                open_crossing(crossings, counts, samples[4], samples[5], bracket, half, signal, owner, results)
                for first in range(max(k - 3, 0), min(k, places - 3) if k <= i + 2 else 0):
                    slight = SLIGHT if first == k - 2 else 0.0
                    flat, tangent = flat_place(samples, first, signal, slight)
                    if flat:
                        note(results, owner, tangent, half, signal, -FLAT)


def is_negative(samples, j, signal, signals):
    """Return whether a sample of a signal is negative by more than noise."""
    return upper_bound(samples, j, signal, signals) < 0.0


def may_be_noise(samples, j, signal, signals):
    """Return whether a sample of a signal has a value that is not clear of zero."""
    value = sample(samples, j, signal)
    return abs(value) <= upper_bound(samples, j, signal, signals) - value


def open_crossing(crossings, counts, lanes, lane, bracket, half, signal, owner, results):
    """Open a bracket about a zero."""
    nth = counts[lane]
    if nth == MOST:
        results[1][owner] = 1.0
    else:
        counts[lane] += 1
        open_zero(crossings, nth * lanes + lane, bracket, bracket[0], half, signal, owner, OPEN)


def flat_place(samples, j, signal, slight):
    """Return whether a signal that crosses zero between two of four samples may do so three times, and where: where the
    slope of the cubic through them is least, near the zero, and of the other sign or slight against the middle one."""
    w, x, y, z = place(samples, j), place(samples, j + 1), place(samples, j + 2), place(samples, j + 3)
    first, rise = sample(samples, j, signal), (sample(samples, j + 1, signal) - sample(samples, j, signal)) / (x - w)
    slope = (sample(samples, j + 2, signal) - sample(samples, j + 1, signal)) / (y - x)
    after = (sample(samples, j + 3, signal) - sample(samples, j + 2, signal)) / (z - y)
    bend = (slope - rise) / (y - w)
    change = ((after - slope) / (z - x) - bend) / (z - w)
    at = (w + x + y - bend / change) / 3.0
    p, q, r, step = at - w, at - x, at - y, (z - w) / 3.0
    least = rise + bend * (p + q) + change * (p * q + q * r + r * p)
    height = first + p * (rise + q * (bend + r * change))
    side = 1.0 if slope > 0.0 else -1.0
    near = side * change > 0.0 and w < at and at < z and abs(height) < 0.6 * abs(change) * step * step * step
    return near and -2.4 * side * change * step * step < side * least and side * least < slight * side * slope, at


def find_zeros(crossings, counts, lanes, own, evaluate, front, results):
    """Refine all brackets of zeros by the Illinois method, and note the zeros of designs from `front` on."""
    columns = used_columns(counts, lanes)
    for k in range(columns):
        if k // lanes >= counts[k % lanes]:
            crossings[HOLDS, k] = float(SETTLED)
    for _ in range(STEPS):
        still_open = 0
        for k in range(columns):
            still_open += 1 if crossings[HOLDS, k] == OPEN else 0
        if still_open == 0:
            break
        place_on_lines(crossings, columns)
        call(evaluate, (own, crossings, TRIAL, AT_TRIAL, SIDE, SIGNAL_NUMBER, 0, columns))
        narrow(crossings, columns)
    for k in range(columns):
        if crossings[HOLDS, k] == SETTLED and k // lanes < counts[k % lanes]:
            zero, half, signal = crossings[STOP, k], crossings[SIDE, k], crossings[SIGNAL_NUMBER, k]
            note(results, front + k % lanes, zero, half, signal, 0.0)
