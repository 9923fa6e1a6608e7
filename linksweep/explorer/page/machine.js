// The machine in a position, to scale, with an arrow for the force in each joint, and pins that can be dragged.

const HALF = 13;        // pixels: half a side of a block
const LONGEST = 0.24;   // of the smaller side of the drawing: the longest arrow
const OFF_SCALE = 1.3;  // of the longest arrow: those of forces beyond the scale
const ROOM = 34;        // pixels about the machine and its arrows
const EVERY = 6;        // of the angles are looked at for the scale
const STICKY = 9;       // pixels about the crank's circle on which its pin stays

class Machine {
  constructor(picture, handles, dragging) {
    this.picture = picture;
    this.dragging = dragging;
    this.held = null;
    this.angle = 0;
    this.layers = {};
    this.root = svg("svg", {class: "machine", role: "img", "aria-label": "The mechanism with its joint forces"});
    const defs = svg("defs");
    for (const force of [...picture.forces, LOAD]) defs.append(this.head(force));
    this.root.append(defs);
    for (const name of ["grid", "ghost", "ground", "links", "centres", "pins", "arrows", "names", "handles"])
      this.root.append(this.layers[name] = svg("g", {class: name}));
    this.make(handles);
    sized(this.root, (width, height) => { this.width = width; this.height = height; this.frame(); });
  }

  head(force) {
    const tip = svg("path", {d: "M0 0L9 4.5L0 9L2 4.5Z", fill: force.color});
    return svg("marker", {id: `head-${force.name}`, viewBox: "0 0 9 9", refX: 7.5, refY: 4.5, markerWidth: 9,
      markerHeight: 9, markerUnits: "userSpaceOnUse", orient: "auto"}, tip);
  }

  make(handles) {
    const {ground, links, names, pins, arrows} = this.layers, {picture} = this;
    this.curve = ground.appendChild(svg("path", {class: "curve"}));
    this.circle = ground.appendChild(svg("circle", {class: "circle"}));
    this.standing = ground.appendChild(svg("g"));
    this.ways = picture.blocks.map(block => block.on && links.appendChild(svg("g")));
    this.blocks = picture.blocks.map(() => links.appendChild(svg("path", {class: "block"})));
    this.cylinders = picture.cylinders.map(() => ["rod", "barrel edge", "barrel"].map(part =>
      links.appendChild(svg("line", {class: part}))));
    this.links = picture.links.map(link => ["edge", "bar"].map(part =>
      links.appendChild(svg("path", {class: part + (link.pins.length > 2 ? " plate" : "")}))));
    this.ways.forEach(way => way && ["edge", "bar"].forEach(part => way.append(svg("path", {class: part}))));
    this.arrows = picture.forces.map(force => arrows.appendChild(
      svg("line", {class: "arrow", stroke: force.color, "marker-end": `url(#head-${force.name})`})));
    this.labels = picture.forces.map(force => names.appendChild(
      svg("text", {class: "force", fill: force.color}, symbol(force.name))));
    this.centres = []; this.dots = {}; this.letters = {}; this.handles = {};
    for (const pin of this.pinNames()) {
      this.dots[pin] = pins.appendChild(svg("circle", {class: "pin", r: 3.6}));
      this.letters[pin] = names.appendChild(svg("text", {class: "letter"}, pin));
    }
    for (const pin of handles) this.handles[pin] = this.layers.handles.appendChild(this.handle(pin));
  }

  // The sign of a centre of gravity.
  centre() {
    return svg("g", {class: "centre-of-gravity"}, svg("title", {}, "Centre of gravity"), svg("circle", {r: 4.5}),
      svg("path", {d: "M0 0V-4.5A4.5 4.5 0 0 1 4.5 0ZM0 0V4.5A4.5 4.5 0 0 1 -4.5 0Z"}));
  }

  pinNames() {
    const {picture} = this;
    const all = [...picture.ground, ...picture.links.flatMap(link => link.pins), ...picture.blocks.map(block => block.pin),
      ...picture.cylinders.flat()];
    return [...new Set(all)].filter(pin => !pin.endsWith("_"));
  }

  handle(pin) {
    const made = svg("circle", {class: "handle", r: 12, tabindex: 0, role: "button", "aria-label": `Pin ${pin}: drag, or arrow keys`});
    made.append(svg("title", {}, `Drag pin ${pin}; or focus it and press the arrow keys`));
    made.addEventListener("pointerdown", event => {
      made.setPointerCapture(event.pointerId);
      event.preventDefault();
      made.focus({preventScroll: true});
      this.held = pin;
      this.dragging.start(pin);
    });
    made.addEventListener("pointermove", event => {
      if (this.held !== pin) return;
      const box = this.root.getBoundingClientRect();
      this.dragging.move(pin, this.snapped(pin, this.world([event.clientX - box.left, event.clientY - box.top])), this.angle);
    });
    const release = () => {
      if (this.held !== pin) return;
      this.held = null;
      this.dragging.end();
      this.frame();
    };
    made.addEventListener("pointerup", release);
    made.addEventListener("pointercancel", release);
    made.addEventListener("keydown", event => {
      const way = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]}[event.key];
      if (!way) return;
      event.preventDefault(); event.stopPropagation();
      const place = at(this.cycle.pins[pin], this.index(this.cycle));
      this.dragging.start(pin);
      this.dragging.move(pin, add(place, way, (event.shiftKey ? 10 : 1) / this.scale), this.angle);
      this.dragging.end();
    });
    return made;
  }

  // The crank's pin stays on its circle while the mouse is near it: then the crank turns, and keeps its length.
  snapped(pin, place) {
    const [pivot, end] = this.picture.links[0].pins;
    if (pin !== end) return place;
    const centre = at(this.cycle.pins[pivot], 0), arm = less(place, centre), length = Math.hypot(...arm);
    if (Math.abs(length - this.crank) * this.scale > STICKY) return place;
    return add(centre, arm, this.crank / length);
  }

  index(cycle) { return Math.round(this.angle / cycle.step); }
  screen([x, y]) { return [this.x0 + this.scale * x, this.y0 - this.scale * y]; }
  world([x, y]) { return [(x - this.x0) / this.scale, (this.y0 - y) / this.scale]; }

  show(cycle, pinned) {
    this.cycle = cycle;
    this.pinned = pinned;
    this.loads?.remove();
    this.loads = new Loads(cycle.loads, this.layers.arrows, this.layers.names);
    while (this.centres.length < cycle.centres.length) this.centres.push(this.layers.centres.appendChild(this.centre()));
    this.centres.splice(cycle.centres.length).forEach(made => made.remove());
    const [pivot, end] = this.picture.links[0].pins, centre = at(cycle.pins[pivot], 0), ends = cycle.pins[end];
    const turned = Array.from({length: count(ends)}, (_, k) => at(ends, k)).find(known); // where it can be assembled
    if (this.held !== end && turned) this.crank = Math.hypot(...less(turned, centre));
    this.frame();
  }

  // Draw anew; to another scale unless a pin is held: what moves under the mouse must not jump.
  frame() {
    if (!this.width || !this.cycle) return;
    if (this.held === null || !this.scale) this.fit();
    this.still();
    this.draw(this.angle);
  }

  // Choose scale and place so that all positions and arrows are inside; arrows have the same length at any scale.
  fit() {
    this.top = most(Object.values(this.cycle.forces).map(pair => top(sizes(pair)))) || 1;
    const points = [];
    for (const cycle of [this.cycle, this.pinned]) if (cycle) {
      for (const pair of [...Object.values(cycle.pins), cycle.curve])
        for (let k = 0; k < count(pair); k += EVERY) points.push([at(pair, k), [0, 0]]);
    }
    for (const {name, pin} of this.picture.forces)
      for (let k = 0; k < count(this.cycle.forces[name]); k += EVERY)
        points.push([at(this.cycle.pins[pin], k), this.arrow(at(this.cycle.forces[name], k)) ?? [0, 0]]);
    for (const {place, force, end} of this.cycle.loads) {
      for (let k = 0; force && k < count(force); k += EVERY)
        points.push([at(place, k), (this.arrow(at(force, k)) ?? [0, 0]).map(x => -x)]);
      for (const still of end ? [place, end] : []) for (let k = 0; k < count(still); k += EVERY) points.push([at(still, k), [0, 0]]);
    }
    const extent = scale => {
      const xs = points.map(([[x], [dx]]) => scale * x + dx), ys = points.map(([[, y], [, dy]]) => dy - scale * y);
      return [least(xs), most(xs), least(ys), most(ys)];
    };
    const fits = ([x1, x2, y1, y2]) => x2 - x1 <= this.width - 2 * ROOM && y2 - y1 <= this.height - 2 * ROOM;
    let [low, high] = [0, 1];
    while (fits(extent(high)) && high < 1e12) high *= 4;
    for (let halving = 0; halving < 24; halving++) {
      const middle = low > 0 ? Math.sqrt(low * high) : high / 4;
      if (fits(extent(middle))) low = middle; else high = middle;
    }
    this.scale = low || high;
    const [x1, x2, y1, y2] = extent(this.scale);
    this.x0 = (this.width - x1 - x2) / 2;
    this.y0 = (this.height - y1 - y2) / 2;
  }

  still() {
    const {cycle} = this, {grid, ghost} = this.layers;
    set(this.root, {viewBox: `0 0 ${this.width} ${this.height}`});
    grid.replaceChildren(...this.gridLines());
    set(this.curve, {d: this.closed(cycle.curve)});
    const [pivot] = this.picture.links[0].pins, [cx, cy] = this.screen(at(cycle.pins[pivot], 0));
    set(this.circle, {cx, cy, r: this.crank * this.scale});
    this.standing.replaceChildren(
      ...this.picture.blocks.flatMap((block, k) => (cycle.rails[k] ? this.rail(block, cycle.rails[k]) : [])),
      ...cycle.wheels.map(([pin, radius]) => this.wheel(pin, radius)),
      ...this.picture.ground.map(pin => this.support(pin)));
    ghost.replaceChildren();
    if (this.pinned) ghost.append(svg("path", {class: "curve", d: this.closed(this.pinned.curve)}), this.shadow = svg("path", {class: "shadow"}));
  }

  closed(pair) { return path(count(pair) + 1, k => this.screen(at(pair, k))); }

  gridLines() {
    const [x1, y2] = this.world([0, 0]), [x2, y1] = this.world([this.width, this.height]);
    const lines = [], every = Math.max(2, Math.round(this.width / 110));
    const xs = ticks(x1, x2, every), step = xs[1] - xs[0] || 1;
    const ys = ticks(y1, y2, (y2 - y1) / step);
    for (const x of xs) {
      const [px] = this.screen([x, 0]);
      lines.push(svg("line", {x1: px, x2: px, y1: 0, y2: this.height}));
      if (px > 26 && px < this.width - 30) lines.push(svg("text", {x: px, y: this.height - 5, "text-anchor": "middle"}, number(x)));
    }
    for (const y of ys) {
      const [, py] = this.screen([0, y]);
      lines.push(svg("line", {x1: 0, x2: this.width, y1: py, y2: py}));
      if (py > 12 && py < this.height - 20) lines.push(svg("text", {x: 4, y: py - 3}, number(y)));
    }
    lines.push(svg("text", {x: this.width - 5, y: this.height - 5, "text-anchor": "end"}, this.picture.units.length));
    return lines;
  }

  rail(block, [point, along]) {
    const pair = this.cycle.pins[block.pin], way = [];
    for (let k = 0; k < count(pair); k++) way.push(dot(less(at(pair, k), point), along));
    const [a, b] = [least(way), most(way)].map(t => this.screen(add(point, along, t)));
    if (!known(a)) return [];
    const u = [along[0], -along[1]], v = left(u), made = [];
    const reach = HALF + 10, [p, q] = [add(a, u, -reach), add(b, u, reach)];
    made.push(svg("line", {class: "centre", x1: add(p, u, -14)[0], y1: add(p, u, -14)[1], x2: add(q, u, 14)[0], y2: add(q, u, 14)[1]}));
    for (const side of [HALF, -HALF]) {
      const [s, t] = [add(p, v, side), add(q, v, side)], length = Math.hypot(...less(t, s));
      made.push(svg("line", {class: "guide", x1: s[0], y1: s[1], x2: t[0], y2: t[1]}));
      let d = "";
      for (let x = 4; x < length; x += 7) {
        const foot = add(s, u, x), end = add(add(foot, v, Math.sign(side) * 5), u, -5);
        d += `M${foot.map(z => z.toFixed(1))}L${end.map(z => z.toFixed(1))}`;
      }
      made.push(svg("path", {class: "hatch", d}));
    }
    return made;
  }

  wheel(pin, radius) {
    const [cx, cy] = this.screen(at(this.cycle.pins[pin], 0));
    return svg("circle", {class: "circle", cx, cy, r: radius * this.scale || 0});
  }

  support(pin) {
    const [x, y] = this.screen(at(this.cycle.pins[pin], 0));
    const strokes = [-9, -4, 1, 6].map(s => `M${s + 3} 14L${s - 1} 18.5`).join("");
    return svg("g", {class: "support", transform: `translate(${x} ${y})`},
      svg("path", {d: "M0 0L-8 14L8 14Z"}), svg("path", {class: "hatch", d: `M-12 14L12 14${strokes}`}));
  }

  draw(angle) {
    this.angle = angle;
    if (!this.width || !this.cycle) return;
    const {cycle, picture} = this, k = this.index(cycle);
    const places = {};
    for (const pin in cycle.pins) places[pin] = this.screen(at(cycle.pins[pin], k));
    picture.links.forEach((link, j) => this.drawLink(this.links[j], link.pins.map(pin => places[pin])));
    picture.blocks.forEach((block, j) => this.drawBlock(block, j, places, k));
    picture.cylinders.forEach((ends, j) => this.drawCylinder(j, ends, places));
    for (const pin in this.dots) {
      const [x, y] = places[pin], shown = known(places[pin]);
      const display = shown ? "" : "none";
      set(this.dots[pin], shown ? {cx: x, cy: y, display} : {display});
      set(this.letters[pin], shown ? {x: x - 9, y: y - 9, display} : {display});
      if (this.handles[pin]) set(this.handles[pin], shown ? {cx: x, cy: y, display} : {display});
    }
    picture.forces.forEach((force, j) => this.drawForce(j, places[force.pin], at(cycle.forces[force.name], k)));
    this.loads.draw(k, point => this.screen(point), force => this.arrow(force), HALF);
    this.centres.forEach((made, j) => {
      const [x, y] = this.screen(at(cycle.centres[j], k)), shown = known([x, y]);
      set(made, shown ? {transform: `translate(${x} ${y})`, display: ""} : {display: "none"});
    });
    if (this.pinned) {
      const k = this.index(this.pinned);
      const lines = picture.links.map(link => path(link.pins.length, j => this.screen(at(this.pinned.pins[link.pins[j]], k))));
      set(this.shadow, {d: lines.join("")});
    }
  }

  drawLink(parts, points) {
    let d = "";
    if (points.every(known)) {
      const middle = points.reduce((sum, point) => add(sum, point, 1 / points.length), [0, 0]);
      const around = point => Math.atan2(...less(point, middle));
      const corners = points.length > 2 ? [...points].sort((a, b) => around(a) - around(b)) : points;
      d = path(corners.length, k => corners[k]) + (points.length > 2 ? "Z" : "");
    }
    for (const part of parts) set(part, {d});
  }

  drawBlock(block, j, places, k) {
    const centre = places[block.pin], [ux, uy] = at(this.cycle.blocks[j], k), u = [ux, -uy], v = left(u);
    const corner = (a, b) => add(add(centre, u, a * HALF), v, b * 0.85 * HALF).map(z => z.toFixed(1)).join(" ");
    set(this.blocks[j], {d: known(centre) ? `M${corner(-1, -1)}L${corner(1, -1)}L${corner(1, 1)}L${corner(-1, 1)}Z` : ""});
    if (!this.ways[j]) return;
    const pin = block.on[1], pair = this.cycle.pins[block.pin], arm = this.cycle.pins[pin], way = [];
    for (let m = 0; m < count(pair); m++) way.push(dot(less(at(pair, m), at(arm, m)), at(this.cycle.blocks[j], m)));
    const pivot = places[pin], foot = add(pivot, v, dot(less(centre, pivot), v));
    const ends = [Math.min(0, least(way) * this.scale - 1.6 * HALF), Math.max(0, most(way) * this.scale + 1.6 * HALF)].map(t => add(foot, u, t));
    const d = known(foot) ? path(3, m => [ends[0], ends[1], foot][m]) + path(2, m => [foot, pivot][m]) : "";
    for (const part of this.ways[j].children) set(part, {d});
  }

  drawCylinder(j, ends, places) {
    const [a, b] = ends.map(pin => places[pin]);
    const pairs = ends.map(pin => this.cycle.pins[pin]), lengths = [];
    for (let k = 0; k < Math.max(...pairs.map(count)); k++) lengths.push(Math.hypot(...less(at(pairs[0], k), at(pairs[1], k))));
    const span = less(b, a), end = add(a, span, 0.8 * least(lengths) * this.scale / (Math.hypot(...span) || 1));
    const display = known(end) ? "" : "none";
    const [rod, ...barrel] = this.cylinders[j];
    set(rod, known(end) ? {x1: end[0], y1: end[1], x2: b[0], y2: b[1], display} : {display});
    for (const part of barrel) set(part, known(end) ? {x1: a[0], y1: a[1], x2: end[0], y2: end[1], display} : {display});
  }

  // Arrow of a force, (dx, dy) in pixels.
  arrow(force) {
    const size = Math.hypot(...force), long = LONGEST * Math.min(this.width, this.height);
    const length = Math.min(size / this.top, OFF_SCALE) * long;
    return known(force) && length > 2 ? [force[0] / size * length, -force[1] / size * length] : null;
  }

  drawForce(j, start, force) {
    const arrow = known(start) && this.arrow(force);
    this.drawArrow(this.arrows[j], this.labels[j], start, arrow && add(start, arrow));
  }

  // The name stands beyond the tip.
  drawArrow(line, label, start, tip) {
    const length = start && tip ? Math.hypot(...less(tip, start)) : 0;
    set(line, length ? {x1: start[0], y1: start[1], x2: tip[0], y2: tip[1], display: ""} : {display: "none"});
    const u = length > 14 && less(tip, start).map(x => x / length), name = u && add(tip, u, 13);
    set(label, name ? {x: name[0], y: name[1] + 4, display: ""} : {display: "none"});
  }
}
