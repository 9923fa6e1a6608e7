"""Scene files: TOML with the same words as the constructors, where a number may carry its unit.

::

    omega2 = "1500 rpm"
    gravity = [0, -9.81]

    [mechanism]
    type = "FourBar"
    ground = "20 cm"

    [mechanism.crank]
    type = "Bar"
    length = {dim = "crank_length", start = "6 cm", stop = "9 cm", num = 31}
    ...

    [[loads]]
    link = "coupler"
    force = [0, "-80 lbf"]
    at = ["10 cm", 15]

    [[loads]]
    type = "Spring"
    from_ = ["ground", 0.3, 0]
    to = ["rocker", "10 cm", 15]
    rate = "2 N/mm"
    free_length = "50 mm"

In place of a number, a design axis is ``{dim = "width", values = [...]}``, or with ``start``, ``stop`` and
``num`` for values; over more dims ``{dims = ["a", "b"], values = [[...], [...]]}``. ``unit = "cm"`` is for
plain numbers, ``coords = {a = [...]}`` are labels, ``theta2 = [...]`` is short for angles [degree] there.
A number that changes over the revolution may stand in a CSV file, ``{csv = "indicator.csv", column = "P",
unit = "kN"}``: see `linksweep.scene.file.csv_table`. One force in place of two acts on a slider, along its guide.
Without coords, the values of a dim that occurs once in the file are its labels.

All errors of a file are reported at once, one a line: ``scene.toml:12: coupler.lenght: unknown key; did you
mean "length"?``. Paths are those of the constructors; lists count from one, as engineers do: ``loads[1]``.

The kinds of the dataclasses' fields (`linksweep.base.fields`) say what stands in a file: a new machine or load needs
no line here.
"""
