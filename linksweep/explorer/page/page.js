// The page: its layout, its clock, and its questions to Python, one at a time.

const TURN_TIME = 5; // seconds for a turn of the crank on the screen

class Page {
  constructor(model) {
    this.model = model;
    this.queue = []; this.latest = null; this.exact = false; this.busy = false; this.gestures = 0;
    this.angle = 45; this.playing = !matchMedia("(prefers-reduced-motion: reduce)").matches;
    this.root = html("div", {class: "sheet", tabindex: -1}, html("p", {class: "wait"}, "Starting …"));
    this.root.addEventListener("keydown", event => this.key(event));
    model.on("msg:custom", reply => this.received(reply));
    this.ask({ask: "start"});
  }

  // Questions wait in line; of changes that wait only the latest counts; exact peaks come when nothing newer waits.
  ask(question) { this.settle(); this.queue.push(question); this.next(); }
  change(question) { this.latest = question; this.next(); }
  settle() { if (this.latest) this.queue.push(this.latest); this.latest = null; }
  next() {
    if (this.busy) return;
    this.settle();
    if (!this.queue.length && this.exact) { this.queue.push({ask: "exact"}); this.exact = false; }
    this.busy = this.queue.length > 0;
    this.root.setAttribute("aria-busy", this.busy);
    if (!this.busy) return;
    this.model.send_msg(this.queue.shift());
    this.late = setTimeout(() => this.say("Waiting for Python …"), 4000);
  }

  received(reply) {
    clearTimeout(this.late);
    this.busy = false;
    if (reply.ask === "start" && !this.machine) this.build(reply);
    if (this.machine) this.take(reply);
    this.next();
  }

  take(reply) {
    this.say(reply.refusal ?? reply.cycle?.problem ?? (reply.ask === "exact" ? null : ""), "refusal" in reply);
    if ("refusal" in reply && this.cycle) this.controls.show(this.values, this.branches, this.pinned?.values);
    if ("pinned" in reply) this.pinned = reply.pinned;
    if (reply.cycle) {
      Object.assign(this, {cycle: reply.cycle, values: reply.values, branches: reply.branches, exact: true, peaks: null});
      this.table.classList.add("old");
      this.undo.disabled = !reply.undo;
      this.redo.disabled = !reply.redo;
    }
    if (reply.angle !== undefined) this.angle = reply.angle;
    if (reply.peaks) Object.assign(this, {peaks: reply.peaks, checks: reply.checks});
    if (reply.cycle || "pinned" in reply) this.show();
    if (reply.peaks) this.curves();
    if (reply.peaks || "pinned" in reply) this.tables();
    if (reply.text) save(reply);
  }

  build(start) {
    const {title, picture, handles, controls, branches} = start;
    this.picture = picture;
    this.controls = new Controls(controls, branches, (numbers, gesture) => this.change({ask: "set", numbers, gesture}),
      () => ++this.gestures, (path, branch) => this.ask({ask: "assemble", path, branch}));
    this.machine = new Machine(picture, handles, {
      start: () => { this.gesture = ++this.gestures; this.resume = this.playing; this.play(false); },
      move: (pin, place, angle) => this.change({ask: "drag", pin, place, angle, gesture: this.gesture}),
      end: () => this.play(this.resume),
    });
    const scrub = angle => { this.play(false); this.turnTo(angle); };
    this.forceChart = new Curves("Joint forces over the crank angle", scrub);
    this.driveChart = new Curves("Drive over the crank angle", scrub);
    this.loads = picture.forces.map(force => new LoadDiagram(force));
    this.readings = Object.fromEntries([...picture.forces.map(force => force.name), "drive"].map(name => [name, html("b", {})]));
    this.root.replaceChildren(this.bar(title), this.controls.root, this.stage(), this.side(), this.results());
    requestAnimationFrame(time => this.tick(time));
  }

  bar(title) {
    const button = (text, hint, action, name) => html("button", {type: "button", title: hint, onclick: action, class: name}, text);
    this.undo = button("Undo", "Ctrl+Z", () => this.ask({ask: "undo"}), "undo");
    this.redo = button("Redo", "Ctrl+Shift+Z", () => this.ask({ask: "redo"}), "redo");
    this.keep = button("Pin design", "Keep this design in grey, and compare with it", () => this.ask({ask: this.pinned ? "unpin" : "pin"}), "keep");
    this.back = button("Back to it", "Return to the pinned design", () => this.ask({ask: "restore"}), "back");
    const saves = [["TOML", "toml", "Scene file"], ["Report", "report", "Page to print: inputs, checks, peaks, figures"], ["Python", "python", "Lines that make this scene"]];
    return html("header", {}, html("h1", {}, title),
      html("div", {class: "tools"}, this.undo, this.redo, html("i", {}), this.keep, this.back, html("i", {}), html("span", {}, "Save as"),
        ...saves.map(([text, form, hint]) => button(text, hint, () => { this.say("Writing …"); this.ask({ask: "export", form}); }, form))));
  }

  stage() {
    this.note = html("p", {class: "note", role: "status", "aria-live": "polite"});
    this.player = html("button", {type: "button", class: "play", title: "Space", onclick: () => this.play(!this.playing)});
    this.dial = html("input", {type: "range", min: 0, max: 360, step: 0.5, "aria-label": "Crank angle",
      oninput: () => { this.play(false); this.turnTo(+this.dial.value); }});
    this.reading = html("output", {});
    return html("section", {class: "stage"}, this.machine.root, this.note,
      html("div", {class: "transport"}, this.player, this.dial, this.reading));
  }

  side() {
    const legend = this.picture.forces.map(force => html("span", {style: `color:${force.color}`}, symbol(force.name), " ", this.readings[force.name]));
    const {drive} = this.picture, word = /^T\d/.test(drive.name) ? "Drive torque" : "Drive force";
    const cards = this.loads.map((load, k) => html("figure", {}, load.root, html("figcaption", {style: `color:${load.force.color}`},
      symbol(load.force.name), html("small", {}, ` ${load.force.joint}`))));
    return html("section", {class: "side"},
      html("h2", {}, "Joint forces ", html("small", {}, this.picture.units.force)), html("div", {class: "legend"}, ...legend), this.forceChart.root,
      html("h2", {}, `${word} `, html("small", {}, drive.unit), html("span", {class: "now"}, `${symbol(drive.name)} `, this.readings.drive)), this.driveChart.root,
      html("h2", {}, "Load diagrams ", html("small", {}, `${this.picture.units.force}, in ground axes, each to its own scale`)), html("div", {class: "loads", style: `--columns:${cards.length > 6 ? 4 : cards.length > 4 ? 3 : 2}`}, ...cards));
  }

  results() {
    this.table = html("table", {class: "peaks"});
    this.findings = html("dl", {class: "checks"});
    return html("section", {class: "results"},
      html("div", {class: "exact"}, html("h2", {}, "Exact peaks"), this.table), html("div", {}, html("h2", {}, "Checks"), this.findings));
  }

  say(text, refused = false) {
    if (text === null || !this.note) return;
    this.note.textContent = text;
    this.note.classList.toggle("refused", refused);
  }

  show() {
    const {cycle, pinned} = this;
    this.dial.max = cycle.turn;
    this.controls.show(this.values, this.branches, pinned?.values);
    this.keep.textContent = pinned ? "Unpin" : "Pin design";
    this.back.hidden = !pinned;
    this.root.classList.toggle("compares", !!pinned);
    this.machine.show(cycle, pinned?.cycle);
    this.curves();
    this.loads.forEach(load => load.show(cycle.forces[load.force.name], pinned?.cycle.forces[load.force.name]));
    this.turnTo(this.angle);
  }

  curves() {
    const {cycle, pinned, picture} = this, forces = picture.forces, peaks = this.peaks ?? [];
    const lines = (one, color) => forces.map(force => ({color: color ?? force.color, values: sizes(one.forces[force.name])}));
    const colors = Object.fromEntries(forces.map(force => [force.name, force.color]));
    const marks = name => peaks.filter(peak => name(peak.name)).map(peak => ({...peak, color: colors[peak.name] ?? BLUE,
      text: `${symbol(peak.name)} ${number(peak.value, 6)} ${peak.unit} at ${number(peak.at, 5)}°`}));
    this.forceLines = lines(cycle);
    this.forceChart.show(cycle.turn, this.forceLines, pinned ? lines(pinned.cycle, GHOST) : [], marks(name => name in colors));
    this.driveChart.show(cycle.turn, [{color: BLUE, values: cycle.drive}], pinned ? [{color: GHOST, values: pinned.cycle.drive}] : [],
      marks(name => name === picture.drive.name));
  }

  tables() {
    if (!this.peaks) return;
    const before = Object.fromEntries((this.pinned?.peaks ?? []).map(peak => [peak.name + peak.end, peak.value]));
    const colors = Object.fromEntries(this.picture.forces.map(force => [force.name, force.color]));
    const head = ["", "peak", "", "at", ...(this.pinned ? ["pinned", "change"] : [])].map(text => html("th", {scope: "col"}, text));
    const rows = this.peaks.map(peak => {
      const {name, end, value, unit, at} = peak, old = before[name + end];
      const cells = [precise(value), unit, `${at.toFixed(1)}°`, ...(this.pinned ? [precise(old), change(value, old)] : [])];
      return html("tr", {}, html("th", {scope: "row", style: `color:${colors[name] ?? INK}`}, `${symbol(name)} ${end}`), ...cells.map(text => html("td", {}, text)));
    });
    this.table.replaceChildren(html("thead", {}, html("tr", {}, ...head)), html("tbody", {}, ...rows));
    this.table.classList.remove("old");
    this.findings.replaceChildren(...this.checks.flatMap(([title, text]) => [html("dt", {}, title), html("dd", {}, text)]));
  }

  turnTo(angle) {
    this.angle = ((angle % this.cycle.turn) + this.cycle.turn) % this.cycle.turn;
    const share = this.angle / this.cycle.turn;
    this.machine.draw(this.angle);
    this.forceChart.point(this.angle);
    this.driveChart.point(this.angle);
    this.loads.forEach(load => load.point(share));
    const now = values => values[Math.round(share * values.length) % values.length];
    this.picture.forces.forEach((force, j) => { this.readings[force.name].textContent = steady(now(this.forceLines[j].values), this.forceChart.high); });
    this.readings.drive.textContent = steady(now(this.cycle.drive), this.driveChart.high);
    this.dial.value = this.angle;
    this.reading.textContent = `θ₂ ${this.angle.toFixed(1)}°`;
  }

  play(on) {
    this.playing = on;
    this.root.classList.toggle("playing", on);
    this.player.textContent = on ? "Pause" : "Play";
  }

  tick(time) {
    if (!this.root.isConnected && this.attached) return;
    this.attached ||= this.root.isConnected;
    const passed = Math.min(0.1, (time - (this.time ?? time)) / 1000);
    this.time = time;
    if (this.player.textContent === "") this.play(this.playing);
    if (this.playing && this.cycle) this.turnTo(this.angle + Math.sign(this.cycle.rate || 1) * 360 * passed / TURN_TIME);
    requestAnimationFrame(later => this.tick(later));
  }

  key(event) {
    const control = event.ctrlKey || event.metaKey;
    if (control && event.key.toLowerCase() === "z") this.ask({ask: event.shiftKey ? "redo" : "undo"});
    else if (control && event.key.toLowerCase() === "y") this.ask({ask: "redo"});
    else if (event.composedPath()[0].matches?.("input, select, button, summary")) return;
    else if (event.key === " ") this.play(!this.playing);
    else if (event.key === "ArrowLeft" || event.key === "ArrowRight") { this.play(false); this.turnTo(this.angle + (event.key === "ArrowLeft" ? -1 : 1) * (event.shiftKey ? 10 : 1)); }
    else return;
    event.preventDefault();
  }
}

// Five digits, trailing zeros too, so that a column of numbers is aligned.
function precise(value) {
  const plain = Math.abs(value) >= 1e-3 && Math.abs(value) < 1e5;
  return plain ? value.toPrecision(5).replace("-", "−") : number(value, 5);
}

function change(value, old) {
  if (!Number.isFinite(value) || !Number.isFinite(old) || old === 0) return "";
  const percent = 100 * (value - old) / Math.abs(old), text = Math.abs(percent).toFixed(1);
  return text === "0.0" ? "0" : `${percent > 0 ? "+" : "−"}${text} %`;
}

function save({name, kind, text}) {
  const link = html("a", {href: URL.createObjectURL(new Blob([text], {type: kind})), download: name});
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

export function render({model}) {
  const page = new Page(model);
  if (model.fills) {
    document.body.style.margin = 0;
    page.root.classList.add("fills");
    requestAnimationFrame(() => page.root.focus());
  }
  return page.root;
}
