// A slider and a field for each number of the scene, in groups that fold, and a choice for each assembly.

const ASSEMBLIES = ["open", "crossed"];

class Controls {
  // change(numbers, gesture) asks for other numbers; gesture() starts a new movement; assemble(path, branch) asks for
  // another assembly of those in `branches`
  constructor(controls, branches, change, gesture, assemble) {
    this.change = change;
    this.assemble = assemble;
    this.gesture = gesture;
    this.rows = {};
    this.body = html("div", {class: "groups"});
    const find = html("input", {type: "search", placeholder: "Find a number", "aria-label": "Find a number",
      oninput: () => this.filter(find.value)});
    this.root = html("section", {class: "controls", "aria-label": "Numbers of the scene"}, find, this.body);
    [...grouped(controls)].forEach(([name, members], k) => this.body.append(this.group(name, members.map(one => this.row(one)), k < 3)));
    this.choices = {};
    const rows = Object.keys(branches).map(path => this.choice(path));
    if (rows.length) this.body.prepend(this.group("Assembly", rows, true));
  }

  group(name, rows, open) { return html("details", {open}, html("summary", {}, name), ...rows); }

  choice(path) {
    const id = `number-${path.replace(/\W/g, "-")}`, pin = path.split(".")[1];
    const field = html("select", {id, onchange: () => this.assemble(path, field.value)},
      ...ASSEMBLIES.map(word => html("option", {value: word}, word)));
    const label = html("label", {for: id, title: path}, pin ? `branch of ${pin}` : "branch");
    const row = html("div", {class: "row", "data-path": path}, label, field);
    this.choices[path] = {row, field, name: label.textContent};
    return row;
  }

  row(control) {
    const {path, name, unit, value, low, high, step} = control;
    const id = `number-${path.replace(/\W/g, "-")}`;
    const range = html("input", {type: "range", min: low, max: high, step, "aria-label": `${control.group} ${name}`, tabindex: 0});
    const field = html("input", {type: "text", id, inputmode: "decimal", spellcheck: "false", autocomplete: "off"});
    const label = html("label", {for: id, title: `${path}: double-click for ${number(value, 6)} ${unit}`}, name);
    const row = html("div", {class: "row", "data-path": path}, label, range, field, html("span", {class: "unit"}, unit));
    let current = 0;
    range.addEventListener("pointerdown", () => { current = this.gesture(); });
    range.addEventListener("keydown", event => { if (!event.repeat) current = this.gesture(); });
    range.addEventListener("input", () => {
      field.value = shown(+range.value);
      this.change({[path]: +range.value}, current || this.gesture());
    });
    field.addEventListener("change", () => this.change({[path]: typed(field.value)}, this.gesture()));
    field.addEventListener("keydown", event => { if (event.key === "Enter") field.blur(); event.stopPropagation(); });
    label.addEventListener("dblclick", () => this.change({[path]: value}, this.gesture()));
    this.rows[path] = {row, range, field, control};
    return row;
  }

  // Write the values of a scene, but for what is being typed.
  show(values, branches, pinned) {
    for (const [path, {field}] of Object.entries(this.choices)) field.value = branches[path];
    const active = this.root.getRootNode().activeElement;
    for (const [path, {row, range, field, control}] of Object.entries(this.rows)) {
      const value = values[path];
      if (value === undefined) continue;
      if (value < +range.min) range.min = value;
      if (value > +range.max) range.max = value;
      if (!(active === range && range.matches(":active"))) range.value = value;
      if (active !== field) field.value = shown(value);
      row.classList.toggle("changed", value !== (pinned?.[path] ?? control.value));
    }
  }

  filter(text) {
    const words = text.toLowerCase().split(/\s+/).filter(Boolean);
    const choices = Object.values(this.choices).map(({row, name}) => [row, `assembly ${name}`]);
    const numbers = Object.values(this.rows).map(({row, control}) => [row, `${control.group} ${control.name} ${control.path}`]);
    for (const [row, text] of [...choices, ...numbers]) {
      const all = text.toLowerCase();
      row.hidden = !words.every(word => all.includes(word));
    }
    for (const group of this.body.children) {
      group.hidden = ![...group.querySelectorAll(".row")].some(row => !row.hidden);
      if (words.length) group.open = true;
    }
  }
}

const shown = value => number(value, 5);
const typed = text => text.replaceAll("−", "-");

function grouped(controls) {
  const groups = new Map();
  for (const control of controls) groups.set(control.group, [...(groups.get(control.group) ?? []), control]);
  return groups;
}
