// Curves over the crank angle with exact peaks, and load diagrams: the tip of each force over a cycle.

const MARGIN = {left: 52, right: 10, top: 6, bottom: 18};

class Curves {
  constructor(label, scrub) {
    this.root = svg("svg", {class: "chart", role: "img", "aria-label": label, tabindex: -1});
    for (const name of ["grid", "ghosts", "lines", "marks", "cursor"])
      this.root.append(this[name] = svg(name === "ghosts" || name === "lines" ? "svg" : "g", {class: name}));
    this.cursor.append(this.line = svg("line"));
    const move = event => {
      if (event.type === "pointermove" && !event.buttons) return;
      if (event.type === "pointerdown") this.root.setPointerCapture(event.pointerId);
      const x = event.clientX - this.root.getBoundingClientRect().left;
      if (this.turn) scrub(Math.min(1, Math.max(0, (x - MARGIN.left) / this.wide())) * this.turn);
    };
    this.root.addEventListener("pointerdown", move);
    this.root.addEventListener("pointermove", move);
    this.series = []; this.ghost = []; this.peaks = [];
    sized(this.root, (width, height) => { this.width = width; this.height = height; this.draw(); });
  }

  // series: {color, values}; peaks: {color, at, value, text}
  show(turn, series, ghost, peaks) {
    Object.assign(this, {turn, series, ghost, peaks});
    this.draw();
  }

  wide() { return this.width - MARGIN.left - MARGIN.right; }
  x(angle) { return MARGIN.left + angle / this.turn * this.wide(); }
  y(value) { return this.height - MARGIN.bottom - (value - this.low) / (this.high - this.low) * (this.height - MARGIN.top - MARGIN.bottom); }

  draw() {
    if (!this.width || !this.turn) return;
    set(this.root, {viewBox: `0 0 ${this.width} ${this.height}`});
    const [x, y, width, height] = [MARGIN.left, MARGIN.top, this.wide(), this.height - MARGIN.top - MARGIN.bottom];
    for (const clipped of [this.ghosts, this.lines]) set(clipped, {x, y, width, height, viewBox: `${x} ${y} ${width} ${height}`});
    this.range();
    this.grid.replaceChildren(...this.gridLines());
    this.lines.replaceChildren(...this.series.map(one => this.curve(one)));
    this.ghosts.replaceChildren(...this.ghost.map(one => this.curve(one)));
    this.marks.replaceChildren(...this.peaks.filter(peak => peak.value >= this.low && peak.value <= this.high).map(peak => this.mark(peak)));
    while (this.cursor.children.length < this.series.length + 1) this.cursor.append(svg("circle", {r: 3}));
    this.point(this.angle ?? 0);
  }

  range() {
    const all = [...this.series, ...this.ghost].map(one => one.values);
    const cap = most(all.map(top)) || 1;
    const low = Math.max(-cap, Math.min(0, least(all.map(least)))), high = Math.min(cap, Math.max(0, most(all.map(most))));
    const room = low < high ? 0.06 * (high - low) : 1; // of zeros alone, on both sides
    this.low = low < 0 || low === high ? low - room : 0;
    this.high = high > 0 || low === 0 ? high + room : room;
  }

  curve({color, values}) {
    const n = values.length;
    return svg("path", {stroke: color, d: path(n + 1, k => [this.x(k * this.turn / n), this.y(values[k % n])])});
  }

  mark({color, at, value, text}) {
    return svg("circle", {cx: this.x(at % this.turn), cy: this.y(value), r: 3.4, fill: "white", stroke: color}, svg("title", {}, text));
  }

  gridLines() {
    const made = [], step = angleStep(this.turn);
    for (let angle = 0; angle <= this.turn; angle += step) {
      const x = this.x(angle);
      made.push(svg("line", {x1: x, x2: x, y1: MARGIN.top, y2: this.height - MARGIN.bottom}));
      const anchor = angle === 0 ? "start" : angle === this.turn ? "end" : "middle";
      made.push(svg("text", {x, y: this.height - 4, "text-anchor": anchor}, `${angle}°`));
    }
    for (const value of ticks(this.low, this.high, Math.max(3, this.height / 36))) {
      const y = this.y(value);
      made.push(svg("line", {x1: MARGIN.left, x2: this.width - MARGIN.right, y1: y, y2: y, class: value === 0 ? "zero" : ""}));
      made.push(svg("text", {x: MARGIN.left - 6, y: y + 3.5, "text-anchor": "end"}, number(value)));
    }
    return made;
  }

  point(angle) {
    this.angle = angle;
    if (!this.width || !this.turn) return;
    const x = this.x(angle % this.turn);
    set(this.line, {x1: x, x2: x, y1: MARGIN.top, y2: this.height - MARGIN.bottom});
    this.series.forEach(({color, values}, j) => {
      const value = values[Math.round(angle / this.turn * values.length) % values.length];
      const shown = Number.isFinite(value) && value <= this.high && value >= this.low;
      set(this.cursor.children[j + 1], shown ? {cx: x, cy: this.y(value), fill: color, display: ""} : {display: "none"});
    });
  }
}

const SIDE = 100; // units of a load diagram

class LoadDiagram {
  constructor(force) {
    this.force = force;
    this.root = svg("svg", {class: "load", viewBox: `0 0 ${SIDE} ${SIDE}`, role: "img", "aria-label": `Load diagram of ${force.name}`});
    this.root.append(this.grid = svg("g", {class: "grid"}), this.ghost = svg("path", {class: "ghost"}),
      this.line = svg("path", {class: "tip", stroke: force.color}), this.arrow = svg("line", {stroke: force.color, class: "now"}),
      this.dot = svg("circle", {r: 2.6, fill: force.color}));
  }

  show(pair, ghost) {
    this.pair = pair;
    this.top = Math.max(...[pair, ghost].filter(Boolean).map(one => top(sizes(one)))) || 1;
    const ring = ticks(0, this.top, 3)[1], middle = SIDE / 2, rings = [];
    for (let value = ring; value <= this.top * 1.0001; value += ring)
      rings.push(svg("circle", {cx: middle, cy: middle, r: value / this.top * (middle - 3)}));
    rings.push(svg("line", {x1: 3, x2: SIDE - 3, y1: middle, y2: middle}), svg("line", {y1: 3, y2: SIDE - 3, x1: middle, x2: middle}));
    const edge = ring / this.top * (middle - 3) * Math.SQRT1_2;
    rings.push(svg("text", {x: middle + edge + 1, y: middle + edge + 6}, ring < 1e4 ? number(ring) : `${number(ring / 1e3)}k`));
    this.grid.replaceChildren(...rings);
    set(this.line, {d: this.tips(pair)});
    set(this.ghost, {d: ghost ? this.tips(ghost) : ""});
  }

  tips(pair) { return path(count(pair) + 1, k => this.place(at(pair, k))); }
  place([x, y]) {
    const size = Math.hypot(x, y), reach = (SIDE / 2 - 3) / Math.max(this.top, size / 1.06);
    return [SIDE / 2 + x * reach, SIDE / 2 - y * reach];
  }

  point(share) {
    if (!this.pair) return;
    const n = count(this.pair), [x, y] = this.place(at(this.pair, Math.round(share * n) % n));
    const shown = known([x, y]), display = shown ? "" : "none";
    set(this.arrow, shown ? {x1: SIDE / 2, y1: SIDE / 2, x2: x, y2: y, display} : {display});
    set(this.dot, shown ? {cx: x, cy: y, display} : {display});
  }
}
