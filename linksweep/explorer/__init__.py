"""A machine under the mouse: numbers as sliders, pins to drag; motion, forces, peaks and checks follow.

`model/` has everything but the looks: scene → numbers for the page, tested without a browser. `page/` draws them, in
plain JavaScript and SVG without a library. `widget.py` joins both, and `explore.py` has the two ways in.

The framework is Panel, on Bokeh and Tornado, an optional extra of the package:

- One component (`panel.custom.JSComponent`) runs in a notebook and as a page on localhost. An anywidget runs in
  notebooks alone: its page would need a server of our own, or Voilà, which starts a kernel for each page.
- Its server, which others maintain, listens on this machine alone, refuses other origins, and sends arrays as bytes: a
  cycle of 720 angles is 40 kB and is not written as text.
- It serves its own files, so that the page needs no network.
- A mechanism that turns 60 times a second cannot ask Python for every frame. The page therefore has the whole cycle,
  and asks only when a number changes. Bokeh's own figures, made of glyphs and callbacks for each, would take more code
  for this than the page has, and have no links, pins or arrows.
- ipywidgets with matplotlib draw ten pictures a second, and cannot drag a pin.

An answer takes two questions. The cycle follows every change, in a millisecond or a few; exact peaks and checks are
asked for as soon as no newer change waits. On a small machine they follow the mouse as well, on a large one they come
when it rests.
"""
