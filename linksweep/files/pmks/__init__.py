"""Documents of PMKS+, the Planar Mechanism Kinematic Simulator: drawings of linkages, each one text.

The text is the query of a link to the drawing, or a file ".pmks". Its sections end with a dot, and a list of records
with one dot more:

    flags.scale,….speed,step.units.joint.joint..link.link..force..selection.extras

A record has fields between commas, the first with flags in front of its name. A number is an integer of thousandths in
base 64 (0-9, A-Z, a-z, _, -), negative where it begins with 0; an extra ``PJA~0~0.12345`` has one with more digits.
The last character tells the length; behind an asterisk newer documents have a checksum (FNV-1a, 32 bits).

Lengths are inches, centimetres or metres, with masses in lb, g or kg, moments of inertia in lb in², kg cm² or kg m²,
and forces in lbf or N, whatever units the drawing shows. Angles of guides are radians.

Source: PMKS-Web/PMKSWeb and PMKS-Web/Planar-Mechanism-Kinematic-Simulator on GitHub, folder `transcoding`, and there
"Force Analysis: physical inertia and moment units".
"""
