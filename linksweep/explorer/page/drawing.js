// Elements, numbers and scales that all parts of the page share.

const INK = "#1f2933", GHOST = "#aab4bd", BLUE = "#0072b2";

function element(made, attributes, children) {
  for (const [name, value] of Object.entries(attributes ?? {})) {
    if (name.startsWith("on")) made.addEventListener(name.slice(2), value);
    else if (value === true) made.setAttribute(name, "");
    else if (value !== false && value != null) made.setAttribute(name, value);
  }
  made.append(...children);
  return made;
}

const html = (tag, attributes, ...children) => element(document.createElement(tag), attributes, children);
const svg = (tag, attributes, ...children) =>
  element(document.createElementNS("http://www.w3.org/2000/svg", tag), attributes, children);

function set(made, attributes) {
  for (const name in attributes) made.setAttribute(name, attributes[name]);
}

// "F32" as F₃₂, "F11_3" as F₁₁,₃; a name in words without its underscores.
function symbol(name) {
  if (!/^[A-Z]\d+(_\d+)?[a-z]*$/.test(name)) return name.replaceAll("_", " ");
  return name[0] + name.slice(1).replace("_", ",").replace(/\d/g, digit => "₀₁₂₃₄₅₆₇₈₉"[digit]);
}

// A number with so many significant digits, and a minus as wide as a plus.
function number(value, digits = 4) {
  if (Number.isNaN(value) || value == null) return "–";
  if (!Number.isFinite(value)) return value > 0 ? "∞" : "−∞";
  const size = Math.abs(value);
  const text = size >= 1e6 || (size > 0 && size < 1e-4)
    ? value.toExponential(Math.max(0, digits - 1)).replace(/(\.\d*?)0+e/, "$1e").replace(".e", "e").replace("e+", "e")
    : size >= 10 ** digits ? value.toFixed(0) : String(Number(value.toPrecision(digits)));
  return text.replace(/-/g, "−");
}

// A number with the same count of decimals, and power of ten, whatever its value, so that it does not jump while it
// changes.
function steady(value, top) {
  if (!Number.isFinite(value)) return "–";
  const decade = Math.floor(Math.log10(top || 1)), power = decade < -2 || decade > 6 ? decade : 0;
  const text = (value / 10 ** power).toFixed(Math.max(0, 2 - decade + power)) + (power ? `e${power}` : "");
  return text.replace(/-/g, "−");
}

// Round numbers from low to high, about as many as asked for.
function ticks(low, high, count) {
  const raw = (high - low) / Math.max(1, count), decade = 10 ** Math.floor(Math.log10(raw));
  const step = decade * [1, 2, 5, 10].find(digit => digit * decade >= raw * 0.999);
  const first = Math.ceil(low / step - 1e-9), last = Math.floor(high / step + 1e-9);
  return Array.from({length: last - first + 1}, (_, k) => Number(((first + k) * step).toPrecision(12)));
}

// The step of an axis of crank angles: a part of a turn, or whole turns, so that it has eight numbers at most.
function angleStep(turn) {
  if (turn <= 360) return 90;
  return [180, 360, 720, 1800, 3600, 7200].find(step => turn <= 8 * step) ?? turn;
}

// Places over a cycle: x of all angles, then y. What stands still has one.
const count = pair => pair.length / 2;
const at = (pair, k) => { const n = count(pair); return [pair[k % n], pair[n + k % n]]; };
const known = point => Number.isFinite(point[0]) && Number.isFinite(point[1]);

// A path through points, interrupted where one is not known.
function path(length, point) {
  let text = "", pen = false;
  for (let k = 0; k < length; k++) {
    const [x, y] = point(k), drawn = Number.isFinite(x) && Number.isFinite(y);
    if (drawn) text += `${pen ? "L" : "M"}${x.toFixed(1)} ${y.toFixed(1)}`;
    pen = drawn;
  }
  return text;
}

const least = values => values.reduce((a, b) => (b < a ? b : a), Infinity); // NaN is never less
const most = values => values.reduce((a, b) => (b > a ? b : a), -Infinity);
const sizes = pair => { const n = count(pair); return Array.from({length: n}, (_, k) => Math.hypot(pair[k], pair[n + k])); };

// The largest size of values, for a scale. A pole must not flatten all else: where a few samples are far above the
// others, the scale ends at a few times those.
function top(values) {
  const known = Array.from(values, Math.abs).filter(Number.isFinite).sort((a, b) => a - b);
  const largest = known.at(-1) ?? 0, usual = known[Math.floor(0.97 * known.length)] ?? 0;
  return usual > 0 && largest > 40 * usual ? 5 * usual : largest;
}

const add = (a, b, t = 1) => [a[0] + t * b[0], a[1] + t * b[1]];
const less = (a, b) => [a[0] - b[0], a[1] - b[1]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1];
const left = a => [-a[1], a[0]];

// Calls back with width and height [pixels] of an element now and whenever they change.
function sized(made, callback) {
  new ResizeObserver(([entry]) => {
    const {width, height} = entry.contentRect;
    if (width > 0 && height > 0) callback(width, height);
  }).observe(made);
}
