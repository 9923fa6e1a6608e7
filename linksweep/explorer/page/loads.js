// Symbols of loads: an arrow to the place of a force, three onto a piston for gas, an arc for a torque, a zigzag for a
// spring, a pot for a damper, and for those that turn a spiral and a plate between two arcs.

const LOAD = {name: "load", color: "#5a5148"};
const SIGN = 17;        // pixels: radius of what turns about a pin
const HEAD = 7;         // pixels: arrowheads of a path
const COILS = 6;

class Loads {
  constructor(loads, arrows, names) {
    this.loads = loads;
    this.parts = loads.map(load => ({
      line: arrows.appendChild(svg("line", {class: "arrow load", "marker-end": "url(#head-load)"})),
      path: arrows.appendChild(svg("path", {class: "sign"})),
      heads: arrows.appendChild(svg("path", {class: "heads"})),
      label: names.appendChild(svg("text", {class: "force", fill: LOAD.color}, load.name)),
      dot: arrows.appendChild(svg("circle", {class: "acts", r: 2.4}))}));
  }

  remove() { this.parts.flatMap(part => Object.values(part)).forEach(made => made.remove()); }

  // Draw all at an angle, by its number: place maps metres to pixels, arrow a force to pixels, half is that of a block.
  draw(k, screen, arrow, half) {
    this.loads.forEach((load, j) => {
      const part = this.parts[j], place = screen(at(load.place, k)), push = load.force && arrow(at(load.force, k));
      for (const hidden of [part.line, part.label, part.dot]) set(hidden, {display: "none"});
      for (const empty of [part.path, part.heads]) set(empty, {d: ""});
      if (!known(place)) return;
      if (push) this.force(part, load, place, push, half);
      else if (load.torque) this.turn(part, place, load.torque[k % load.torque.length]);
      else if (load.end) this.between(part, load, place, screen(at(load.end, k)), half);
      else if (!load.force) this.coil(part, load, place);
    });
  }

  force({line, path, heads, label, dot}, load, place, push, half) {
    const length = Math.hypot(...push), u = push.map(x => x / length), gas = load.kind === "gas";
    const tip = gas ? add(place, u, -half) : place, start = less(tip, push);
    set(line, {x1: start[0], y1: start[1], x2: tip[0], y2: tip[1], display: ""});
    set(dot, gas ? {display: "none"} : {cx: place[0], cy: place[1], display: ""});
    this.name(label, length > 14 && add(start, u, -14));
    if (!gas) return;
    const side = left(u).map(x => 0.6 * half * x), rows = [1, -1].map(sign => [add(start, side, sign), add(tip, side, sign)]);
    set(path, {d: lines([rows[0][0], rows[1][0]], ...rows)});
    set(heads, {d: rows.map(([, end]) => head(end, u)).join("")});
  }

  turn({path, heads, label}, place, torque) {
    if (!torque) return;
    const sense = Math.sign(torque), end = polar(place, SIGN, sense > 0 ? 210 : -30);
    const ahead = left(less(end, place)).map(x => -sense * x / SIGN); // y points down on a screen
    set(path, {d: lines(arc(place, SIGN, -30, 210))});
    set(heads, {d: head(add(end, ahead, HEAD), ahead)});
    this.name(label, add(place, [SIGN + 24, SIGN]));
  }

  between({path, label}, load, place, end, half) {
    if (!known(end)) return;
    const span = less(end, place), length = Math.hypot(...span) || 1, u = span.map(x => x / length), v = left(u);
    const wide = Math.min(0.4 * half, 0.2 * length), middle = add(place, span, 0.5), along = (t, s) => add(add(place, span, t), v, s * wide);
    const bends = Array.from({length: 2 * COILS}, (_, k) => along(0.2 + 0.6 * (k + 0.5) / (2 * COILS), k % 2 ? -1 : 1));
    const [a, b] = [add(middle, u, -half / 2), add(middle, u, half / 2)], beside = (point, s) => add(point, v, s * wide);
    const d = load.kind === "spring" ? lines([place, along(0.2, 0), ...bends, along(0.8, 0), end])
      : lines([place, a], [beside(b, 1), beside(a, 1), beside(a, -1), beside(b, -1)], [beside(middle, 0.8), beside(middle, -0.8)], [middle, end]);
    set(path, {d: d + [place, end].map(([x, y]) => `M${x - 2} ${y}a2 2 0 1 0 4 0a2 2 0 1 0 -4 0`).join("")});
    this.name(label, add(middle, v, wide + 16));
  }

  coil({path, label}, load, place) {
    const spiral = Array.from({length: 60}, (_, k) => polar(place, SIGN * (0.4 + 0.6 * k / 59), 810 * k / 59));
    const d = load.kind === "torsion spring" ? lines(spiral)
      : lines(arc(place, SIGN, -45, 225), arc(place, 0.7 * SIGN, -45, 225), [polar(place, 0.75 * SIGN, 90), polar(place, 0.95 * SIGN, 90)]);
    set(path, {d});
    this.name(label, add(place, [SIGN + 24, SIGN]));
  }

  name(label, place) { set(label, place ? {x: place[0], y: place[1] + 4, display: ""} : {display: "none"}); }
}

const lines = (...rows) => rows.map(row => path(row.length, k => row[k])).join("");
const polar = ([x, y], radius, degrees) => [x + radius * Math.cos(degrees * Math.PI / 180), y - radius * Math.sin(degrees * Math.PI / 180)];
const arc = (centre, radius, first, last) => Array.from({length: 40}, (_, k) => polar(centre, radius, first + (last - first) * k / 39));
const head = (tip, u) => `${lines([0.5, 0, -0.5].map(side => add(add(tip, u, side ? -HEAD : 0), left(u), side * HEAD)))}Z`;
