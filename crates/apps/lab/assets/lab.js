// The page: instruments, handles, and the messages of the engine.
import { missing, startEngine, unpack, elementText } from "./driver.js";
import { csv, poster, save, sceneText } from "./files.js";
import { Plot } from "./plots.js";
import { PRESETS } from "./presets.js";
import { Record, envelope, lineNear, notch, spectrum } from "./signals.js";
import { Sound } from "./sound.js";
import { Stage, readPicture } from "./stage.js";
import { G, colourOf, forgetColours, frequencies, named, shown } from "./words.js";

const $ = (id) => document.getElementById(id);

// What the page shows at present.
const lab = {
  facts: null, all: null, engine: null, handles: {}, scene: {}, layout: { perSample: 10 }, record: null, picture: null,
  displacement: new Float32Array(0), running: false, frozen: false, preset: null, speed: null, errors: 0, opened: -1, spectra: {},
};

const inWords = (text) => named(text, lab.facts);

// Texts and names of the page itself that speak of rollers, as they were written.
const written = [];

function collectWritten() {
  const texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node = texts.nextNode(); node; node = texts.nextNode()) {
    const isProse = !["SCRIPT", "STYLE", "CODE"].includes(node.parentElement.tagName);
    if (isProse && /oller/.test(node.data)) written.push({ node, text: node.data });
  }
  document.querySelectorAll("[aria-label*=oller]").forEach((element) => written.push({ element, text: element.getAttribute("aria-label") }));
}

function nameWritten() {
  for (const { node, element, text } of written) {
    if (node) node.data = inWords(text);
    else element.setAttribute("aria-label", inWords(text));
  }
}

function trouble(words) {
  lab.errors += words ? 1 : 0;
  $("trouble").hidden = !words;
  $("trouble").textContent = words || "";
}

// ---- handles

// What stands in which group, as which control. A handle of no group is turned elsewhere.
const GROUPS = [
  ["Operation", ["load", "direction", "speed", "clearance"]],
  ["Surfaces", ["arcs", "facets"]],
  ["Spall", ["spallRing", "spallAngle", "spallLength", "spallDepth", "spallSlope"]],
  ["Friction, oil, damping", ["friction", "viscosity", "contactDamping", "massDamping"]],
  ["Time", ["step"]],
];

const SHORT = {
  load: "Load", direction: "Load turned by", speed: "Speed", clearance: "Clearance, change", arcs: "Touch as", facets: "Facets of a roller",
  spallRing: "Ring", spallAngle: "Place", spallLength: "Length", spallDepth: "Depth", spallSlope: "Edge slope", friction: "Friction",
  viscosity: "Oil, 0: dry", contactDamping: "Contact damping", massDamping: "Mass damping", step: "Longest step",
};

const CHOICES = { arcs: [[0, "facets"], [1, "arcs"]], spallRing: [[0, "none"], [1, "outer"], [2, "inner"]] };

// Range of a slider, in which most is done; the field beside it takes all that the handle takes.
function sliderRange(spec, value) {
  const about = { load: [0, 2.5 * value || 1e4], speed: [0, Math.max(3 * Math.abs(value), 1500)], direction: [-180, 180], clearance: [-50, 100],
    facets: [16, Math.max(200, 2 * value)], spallAngle: [value - 60, value + 60], spallLength: [0.2, Math.max(4, 2.5 * value)],
    spallDepth: [0.005, Math.max(0.1, 2.5 * value)], spallSlope: [20, 90], friction: [0, 0.1], viscosity: [0, 0.3], contactDamping: [0, 1.5],
    massDamping: [0, Math.max(8000, 2 * value)], step: [0.1, Math.max(10, 2 * value)] }[spec.key];
  return about ? about.map((v) => Math.min(spec.most, Math.max(spec.least, v))) : null;
}

const round = (value) => Number(value.toPrecision(6));

function buildHandles() {
  const form = $("handles");
  form.replaceChildren();
  for (const [group, keys] of GROUPS) {
    const head = document.createElement("h4");
    head.textContent = group;
    form.append(head);
    for (const key of keys) form.append(handleRow(lab.facts.specs.find((spec) => spec.key === key)));
  }
}

// What changes the reduction stands there greyed, with the command that makes another lab.
function buildFixed() {
  const row = ([name, value, set], n) => {
    const line = document.createElement("div");
    line.className = "handle off";
    line.innerHTML = `<label for="fixed-${n}"></label><input id="fixed-${n}" disabled>`;
    line.firstChild.textContent = name;
    Object.assign(line.lastChild, { value, title: `in the reduction; ${lab.all.command} --set ${set} makes another lab` });
    return line;
  };
  $("fixed").replaceChildren(...lab.facts.fixed.map(row));
  $("command").textContent = `${lab.all.command} --set ${lab.facts.fixed[2][2]}`;
}

function handleRow(spec) {
  const row = document.createElement("div");
  row.className = "handle";
  row.dataset.key = spec.key;
  const id = `handle-${spec.key}`;
  const choices = CHOICES[spec.key];
  row.innerHTML = `<label for="${id}">${inWords(SHORT[spec.key])}</label><span class="value">${choices
    ? `<select id="${id}">${choices.map(([value, name]) => `<option value="${value}">${name}</option>`).join("")}</select>`
    : `<input id="${id}" inputmode="decimal" aria-describedby="unit-${spec.key}"><span class="unit" id="unit-${spec.key}">${spec.unit}</span>`}</span>`;
  const field = row.querySelector("input, select");
  field.title = `${inWords(spec.name)}${spec.unit ? ` [${spec.unit}]` : ""}, ${spec.least} to ${spec.most}${spec.live ? "" : "; restarts the bearing"}`;
  field.addEventListener("change", () => enter(spec, field.value));
  const range = choices ? null : sliderRange(spec, lab.scene[spec.key]);
  if (range) {
    const slider = Object.assign(document.createElement("input"), { type: "range", min: range[0], max: range[1], step: "any" });
    if (spec.key === "facets") slider.step = 4;
    slider.setAttribute("aria-label", `${inWords(spec.name)}${spec.unit ? ` [${spec.unit}]` : ""}`);
    slider.addEventListener("input", () => { field.value = round(+slider.value); });
    slider.addEventListener("change", () => enter(spec, round(+slider.value)));
    row.append(slider);
  }
  const why = document.createElement("span");
  why.className = "why";
  why.setAttribute("role", "alert");
  row.append(why);
  const off = { direction: lab.facts.guided && "The housing is guided: it moves along its load alone.", speed: lab.facts.varies && "The scene gives its speed over time.", load: lab.facts.varies && "The scene gives its load over time." }[spec.key];
  if (off) { row.classList.add("off"); row.querySelectorAll("input").forEach((input) => { input.disabled = true; input.title = off; }); }
  return row;
}

function enter(spec, text) {
  const value = String(text).trim() === "" ? NaN : Number(text);
  const why = document.querySelector(`[data-key="${spec.key}"] .why`);
  if (!(value >= spec.least && value <= spec.most)) {
    if (why) why.textContent = `${inWords(SHORT[spec.key] || spec.name)} = ${text === "" ? "nothing" : text}: must be a number between ${spec.least} and ${spec.most}${spec.unit ? ` ${spec.unit}` : ""}. It stays at ${lab.handles[spec.key]}.`;
    return;
  }
  if (why) why.textContent = "";
  const whole = ["facets", "spallRing", "arcs", "sensor", "roller"].includes(spec.key);
  turn({ [spec.key]: whole ? Math.round(value) : value });
}

// Asks the engine for some handles by name.
function turn(wanted) {
  if (Object.keys(wanted).some((key) => key !== "roller")) { trouble(""); $("note").textContent = ""; }
  const asked = Object.entries(wanted).map(([key, value]) => [lab.facts.specs.findIndex((spec) => spec.key === key), value]);
  const changed = asked.filter(([n, value]) => lab.handles[lab.facts.specs[n].key] !== value);
  if (!changed.length) return;
  if (changed.some(([n]) => !lab.facts.specs[n].live)) $("speed").textContent = "the bearing comes to its equilibrium…";
  lab.engine.send({ task: "turn", asked: changed });
}

// What a key has moved on the stage, for screen readers.
function tellStage() {
  if (!lab.tell) return;
  lab.tell = false;
  $("told").textContent = inWords(`Sensor at ${lab.facts.sensors[lab.handles.sensor].deg}°; roller ${lab.handles.roller + 1} of ${lab.facts.rollers} is watched.`);
}

function watch(roller) {
  $("follow").checked = false;
  turn({ roller });
}

function showHandles() {
  for (const spec of lab.facts.specs) {
    const row = document.querySelector(`[data-key="${spec.key}"]`), value = lab.handles[spec.key];
    // What stands where it stood is left alone: so is what was refused there, and why.
    if (!row || Number(row.dataset.shown) === value) continue;
    row.dataset.shown = value;
    const [field, slider] = [row.querySelector("select, input:not([type=range])"), row.querySelector("input[type=range]")];
    if (document.activeElement !== field || field.tagName === "SELECT") field.value = field.tagName === "SELECT" ? value : round(value);
    if (slider) slider.value = value;
    row.querySelector(".why").textContent = "";
  }
  for (const spec of lab.facts.specs) {
    const row = document.querySelector(`[data-key="${spec.key}"]`);
    if (!row) continue;
    const needless = (spec.key.startsWith("spall") && spec.key !== "spallRing" && !lab.handles.spallRing) || (spec.key === "facets" && lab.handles.arcs);
    if (!row.querySelector("[disabled]")) row.classList.toggle("off", Boolean(needless));
  }
  $("roller").value = lab.handles.roller + 1;
  $("roller").max = lab.facts.rollers;
}

// ---- presets

function buildPresets() {
  $("presets").replaceChildren(...PRESETS.map((preset) => Object.assign(document.createElement("a"), { href: `#${preset.id}`, textContent: preset.name })));
}

function takePreset(id) {
  const preset = PRESETS.find((one) => one.id === id);
  document.querySelectorAll("nav a").forEach((link) => (link.hash === `#${id}` ? link.setAttribute("aria-current", "true") : link.removeAttribute("aria-current")));
  lab.preset = preset || null;
  if (!preset) { sayWords(); return; }
  const { sensor, roller } = lab.handles;
  $("at-tone").checked = preset.notch;
  if (preset.id === "notch") $("span").value = "0.03";
  turn({ ...preset.set(lab.scene), sensor, roller });
  sayWords();
  run(true);
}

function sayWords() {
  const f = tones();
  $("words").textContent = inWords(lab.preset ? lab.preset.words(f, lab.handles)
    : `${lab.facts.rollers} rollers under ${shown(lab.handles.load, "N")} at ${lab.handles.speed} rpm. Take one of the settings above, or turn a handle: the bearing answers at once.`);
}

const tones = () => frequencies(lab.facts, lab.handles.speed, lab.handles.facets, Boolean(lab.handles.arcs));

// ---- run

function run(on) {
  lab.running = on;
  $("run").textContent = on ? "Pause" : "Run";
  lab.engine.send({ task: "run", on, slow: Number($("slow").value) });
  if (!on) lab.speed = null;
}

let wanted = -1;

async function open(n) {
  wanted = n;
  const bytes = await unpack(`bearing-${n}`);
  // Another one may have been chosen meanwhile.
  if (wanted !== n) return;
  run(false);
  trouble("");
  Object.assign(lab, { opened: n, picture: null, spectra: {}, checked: null, balance: null, speed: null, askedRoller: null, askedSensor: null, displacement: new Float32Array(0) });
  $("checked").textContent = $("note").textContent = "";
  lab.facts = lab.all.bearings[n];
  lab.scene = Object.fromEntries(lab.facts.specs.map((spec, i) => [spec.key, lab.facts.handles[i]]));
  lab.handles = { ...lab.scene };
  const f = lab.facts;
  nameWritten();
  $("lead").textContent = inWords(`${f.title}: ${f.rollers} rollers of ${shown(2 * f.roller, "m")}${f.balls ? ", modelled as cylinders" : ""}, raceways ${shown(2 * f.outer, "m")} and ${shown(2 * f.inner, "m")}, ${f.highestHz > 0 ? `${f.modes} modes below ${shown(f.highestHz * 1.02, "Hz")}` : "rigid rings"}`);
  buildHandles();
  buildFixed();
  stage.open(f);
  lab.record = new Record(lab.layout.perSample, 1 << 17);
  lab.engine.send({ task: "open", bytes, step: f.interval, bearing: n });
}

function receive(message) {
  if (message.of !== undefined && message.of >= 0 && message.of !== lab.opened) {
    if (message.kind === "samples") lab.engine.send({ task: "read" });
    return;
  }
  const tasks = {
    still() {
      lab.handles = Object.fromEntries(lab.facts.specs.map((spec, i) => [spec.key, message.handles[i]]));
      lab.layout = { perSample: message.perSample, beforeRollers: message.beforeRollers, perRoller: message.perRoller };
      stage.still(message);
      if (message.anew || message.opened || lab.lastSensor !== lab.handles.sensor) lab.record.clear();
      lab.lastSensor = lab.handles.sensor;
      tellStage();
      showHandles();
      sayWords();
      if (message.opened) ready();
      lab.dirty = true;
    },
    handles() {
      lab.handles = Object.fromEntries(lab.facts.specs.map((spec, i) => [spec.key, message.handles[i]]));
      tellStage();
      showHandles();
    },
    picture() { lab.picture = readPicture(message.picture, lab.layout); lab.displacement = message.displacement; lab.dirty = true; },
    samples() {
      lab.engine.send({ task: "read" });
      lab.record.add(message.samples);
      tasks.picture();
      if (message.speed) lab.speed = message.speed;
      lab.memory = message.memory;
    },
    began() {
      lab.record.clear();
      lab.began = (lab.began || 0) + 1;
      $("note").textContent = `The run has begun again at its equilibrium, because ${message.why}. A run of the program ends there.`;
    },
    stopped() { lab.running = false; $("run").textContent = "Run"; trouble(`The run has stopped: ${message.why}. “Start anew” begins again from the equilibrium.`); },
    refused() {
      document.querySelectorAll("[data-key]").forEach((row) => delete row.dataset.shown);
      if (message.handles.length) lab.handles = Object.fromEntries(lab.facts.specs.map((spec, i) => [spec.key, message.handles[i]]));
      showHandles();
      trouble(message.task === "open" || message.task === "module" ? message.why : `${message.why}. The handles stay as they were.`);
    },
    checked() { showCheck(message); },
  };
  tasks[message.kind]();
}

function showCheck({ alone, guided, largest, close, course, pieces, until, took }) {
  const share = (off) => (off === 0 ? "nothing" : `${(off / largest).toExponential(1)} of the largest force`);
  lab.checked = { alone: alone / largest, guided: guided / largest, largest, close, course: course.map((off) => off / largest) };
  const good = guided < 1e-9 * largest;
  $("checked").innerHTML = inWords(`<strong class="${good ? "good" : "bad"}">${share(guided)}</strong> is the largest difference, of forces of both raceways on all rollers up to ${shown(largest, "N")}, from ${pieces} states of the program’s run over ${shown(until / pieces, "s")} each. `
    + `In one piece from the start they agree to a billionth until ${shown(close, "s")} and differ by ${share(alone)} at most within ${shown(until, "s")}: two numbers are added at a time here and eight there, products are rounded on their own here, and a roller that strikes makes what that changes larger. (${shown(took / 1000, "s")} of computing.)`);
}

// ---- pictures

const stage = new Stage($("stage"), $("inset"), {
  onSensor: (deg) => {
    const apart = (sensor) => Math.abs(((sensor.deg - deg + 540) % 360) - 180);
    const best = lab.facts.sensors.map((sensor, n) => [apart(sensor), n]).sort((a, b) => a[0] - b[0])[0][1];
    if (best !== lab.handles.sensor && best !== lab.askedSensor) { lab.askedSensor = best; turn({ sensor: best }); }
  },
  onRoller: (roller) => watch(roller),
  // Announced once the engine has applied the change.
  onKey: () => { lab.tell = true; },
});

const plots = {
  trace: new Plot($("trace"), { x: { name: "time", unit: "ms", scale: 1000, base: "s" }, y: { name: "acceleration", unit: "g" } }),
  force: new Plot($("force"), { x: { name: "time", unit: "ms", scale: 1000, base: "s" }, y: { name: "force", unit: "kN", scale: 1e-3 } }),
  spectrum: new Plot($("spectrum"), { x: { name: "frequency", unit: "Hz" }, y: { name: "amplitude", unit: "g" }, log: true }),
  envelope: new Plot($("envelope"), { x: { name: "frequency", unit: "Hz" }, y: { name: "amplitude", unit: "g" } }),
  orbit: new Plot($("orbit"), { x: { name: "x", unit: "µm", scale: 1e6 }, y: { name: "y", unit: "µm", scale: 1e6 }, square: true }),
};

// Acceleration at the sensor in the direction that is chosen [g].
function acceleration(n) {
  const [x, y] = [lab.record.last(1, n), lab.record.last(2, n)], how = $("component").value;
  const angle = lab.facts.sensors[lab.handles.sensor].deg * Math.PI / 180;
  const [cx, cy] = how === "x" ? [1, 0] : how === "y" ? [0, 1] : [Math.cos(angle), Math.sin(angle)];
  return x.map((ax, i) => (cx * ax + cy * y[i]) / G);
}

function markersOf(f) {
  const list = [];
  const add = (name, hz, colour, harmonics) => { for (let k = 1; k <= harmonics; k += 1) if (hz > 0) list.push({ at: k * hz, name: k === 1 ? name : k <= 3 ? `${k}×` : "", colour: colourOf(colour), weak: k > 1 }); };
  return { list, add, f };
}

function defectMarks(add, f) {
  add("BPFO", f.bpfo, "c-green", 5);
  add("BPFI", f.bpfi, "c-orange", 3);
  add("2 BSF", f.twoBsf, "c-purple", 2);
  add("FTF", f.ftf, "c-grey", 1);
}

function drawTraces() {
  const n = Math.max(16, Math.round(Number($("span").value) / lab.facts.interval)), f = tones();
  const time = lab.record.last(0, n), x0 = time[0] ?? 0, dx = lab.facts.interval;
  const range = [x0, x0 + n * dx], raw = acceleration(n), rate = 1 / dx;
  // The paper's notch needs some of the signal before what is shown.
  const cleaned = $("at-tone").checked && f.facets > 0 && f.facets < 0.45 * rate && raw.length > 64 ? notch(raw, rate, f.facets, 15) : null;
  const sensor = lab.facts.sensors[lab.handles.sensor];
  $("trace-name").textContent = `Acceleration at ${sensor.deg}° ${lab.handles.sensor < lab.facts.ownSensors ? `(“${sensor.name}”)` : ""}`;
  plots.trace.show({ range, series: cleaned
    ? [{ name: "as it is", colour: colourOf("c-grey"), y: raw, x0, dx }, { name: "behind the notch", colour: colourOf("c-blue"), y: cleaned, x0, dx, width: 1.6 }]
    : [{ name: "", colour: colourOf("c-blue"), y: raw, x0, dx }] });
  $("force-name").textContent = inWords($("follow").checked && stage.spall() ? `Force on the roller at the spall, now no. ${lab.handles.roller + 1}` : `Force on roller ${lab.handles.roller + 1}`);
  plots.force.show({ range, series: [
    { name: "inner raceway", colour: colourOf("c-orange"), y: lab.record.last(4, n), x0, dx },
    { name: "outer raceway", colour: colourOf("c-blue"), y: lab.record.last(3, n), x0, dx }] });
  // Every fourth sample shows the path, and draws four times as fast.
  const thinned = (column) => lab.record.last(column, 4096).filter((_, i) => i % 4 === 3), [ox, oy] = [thinned(7), thinned(8)];
  let reach = 1e-9, [mx, my] = [0, 0];
  ox.forEach((x, i) => { mx += x / ox.length; my += oy[i] / ox.length; });
  ox.forEach((x, i) => { reach = Math.max(reach, Math.abs(x - mx), Math.abs(oy[i] - my)); });
  const { clientWidth: wide, clientHeight: high } = $("orbit"), aspect = (wide - 60) / Math.max(1, high - 46);
  plots.orbit.show({ range: [mx - 1.15 * reach * aspect, mx + 1.15 * reach * aspect], yRange: [my - 1.15 * reach, my + 1.15 * reach],
    series: [{ name: "", colour: colourOf("c-teal"), x: ox, y: oy, dot: true }] });
}

// Most samples of a spectrum: a page that computes for longer drops pictures.
const SPECTRA = 1 << 16;

function drawSpectra(which) {
  const rate = 1 / lab.facts.interval, f = tones(), signal = acceleration(SPECTRA);
  if (signal.length < 2048) { $("tone").textContent = "The spectrum needs some milliseconds more."; lab.spectra = {}; return; }
  if (which !== "envelope") drawSpectrum(signal, rate, f);
  if (which !== "spectrum") drawEnvelope(signal, rate, f);
}

function drawSpectrum(signal, rate, f) {
  // A line is as wide as the record is short: half of what is there, up to a third of a second.
  let n = 1024;
  while (2 * n <= Math.min(signal.length, 32768)) n *= 2;
  const used = $("at-tone").checked && f.facets > 0 ? notch(signal, rate, f.facets, 15) : signal;
  const s = spectrum(used, rate, n), top = Math.min(0.5 * rate, Number($("reach").value));
  const { list, add } = markersOf(f);
  add(`${lab.handles.facets}·f_spin`, f.facets, "c-red", Math.floor(top / Math.max(1, f.facets)));
  if (top < 3000) defectMarks(add, f);
  plots.spectrum.show({ range: [0, top], markers: list, note: `${shown(s.step, "Hz")} a line, ${s.segments} segment${s.segments > 1 ? "s" : ""}`,
    series: [{ name: "", colour: colourOf("c-blue"), y: s.amplitude, x0: 0, dx: s.step }] });
  const line = f.facets > 0 && f.facets < 0.5 * rate ? lineNear(s, f.facets, Math.max(3 * s.step, 0.005 * f.facets)) : null;
  $("tone").textContent = lab.handles.arcs ? "Arcs have no corners: no line is expected where facets would pass."
    : line ? inWords(`Corners of rollers pass at ${shown(f.facets, "Hz")}; the highest line there stands at ${shown(line.hz, "Hz")}, ${shown(line.level, "g")}, ${line.above.toFixed(0)} dB above its surroundings.`) : "";
  lab.spectra.tone = line;
  // Where corners would pass, also where there are none.
  const corners = lab.handles.facets * f.spin;
  lab.spectra.corners = corners < 0.5 * rate ? lineNear(s, corners, Math.max(3 * s.step, 0.005 * corners)) : null;
}

function drawEnvelope(signal, rate, f) {
  const [low, high] = [1000 * Number($("low").value), 1000 * Number($("high").value)];
  const e = envelope(signal, rate, low, Math.min(high, 0.49 * rate));
  const es = spectrum(e, rate, e.length), end = Math.max(6 * f.bpfo, 40 * es.step);
  const marks = markersOf(f);
  defectMarks(marks.add, f);
  plots.envelope.show({ range: [0, end], markers: marks.list, note: low < high ? `${shown(es.step, "Hz")} a line` : "the band must begin below its end", series: [{ name: "", colour: colourOf("c-teal"), y: es.amplitude, x0: 0, dx: es.step }] });
  lab.spectra.bpfo = lineNear(es, f.bpfo, 2 * es.step + 0.01 * f.bpfo);
  lab.spectra.bpfoHz = f.bpfo;
}

// Mean force of the rollers on the outer ring beside what it carries: the load, and the weight of ring and housing.
function balance() {
  const n = lab.record.count;
  if (n < 100) return null;
  const mean = (column) => { let sum = 0; const values = lab.record.last(column, n); for (const v of values) sum += v; return sum / values.length; };
  const [x, y] = loadVector(), weight = lab.facts.weight, along = lab.facts.along;
  const carried = -(mean(5) * along[0] + mean(6) * along[1]), load = x * along[0] + y * along[1] - weight * along[1];
  return { carried, load, off: carried / load - 1 };
}

function loadVector() {
  const a = lab.handles.direction * Math.PI / 180, [x, y] = lab.facts.along;
  return [Math.cos(a) * x - Math.sin(a) * y, Math.sin(a) * x + Math.cos(a) * y].map((part) => part * lab.handles.load);
}

function showNumbers() {
  const { rollers, energies: e } = lab.picture, loaded = rollers.filter((r) => r.outer > 0.01 * Math.max(...rollers.map((one) => one.outer)));
  const b = balance();
  lab.balance = b;
  $("numbers").textContent = inWords(`${loaded.length} rollers carry; the most loaded ${shown(Math.max(...rollers.map((r) => r.outer)), "N")}.`
    + (b ? ` Rollers carry ${shown(b.carried, "N")} on average of ${shown(b.load, "N")} (load and weight).` : ""));
  const rows = [["in motion", e.kinetic], ["bending rings", e.strain], ["contacts", e.contact], ["friction, heat", e.friction], ["damping, heat", e.damping], ["contact damping, heat", e.contactDamping], ["oil, heat", e.film], ["work of the load", e.external], ["work of the drive", e.drive], ["imbalance", e.imbalance]];
  const most = Math.max(...rows.map(([, v]) => Math.abs(v)), 1e-12);
  $("energy").innerHTML = rows.map(([name, v]) => `<tr><td>${name}</td><td class="n">${shown(v, "J")}</td><td style="width:35%"><span class="level" style="width:${(100 * Math.abs(v) / most).toFixed(1)}%"></span></td></tr>`).join("");
}

// The roller that comes to the spall next, until half a pitch behind it: the one to watch.
function followed() {
  const spall = stage.spall();
  if (!spall || !$("follow").checked) return;
  const tau = 2 * Math.PI, sense = lab.handles.speed < lab.facts.outerRpm ? 1 : -1, pitch = tau / lab.facts.rollers;
  // On the inner ring rollers fall behind.
  const way = spall.inner ? -sense : sense;
  const ahead = (r) => (((way * (spall.angle - Math.atan2(r.y, r.x)) + 0.5 * pitch) % tau) + tau) % tau;
  const next = lab.picture.rollers.reduce((best, r, n) => (ahead(r) < ahead(lab.picture.rollers[best]) ? n : best), 0);
  if (next !== lab.handles.roller && next !== lab.askedRoller) { lab.askedRoller = next; turn({ roller: next }); }
}

function caption() {
  const lines = [`${shown(lab.picture.time, "s")} of the bearing’s time, steps of ${shown(lab.picture.step, "s")}`];
  if (lab.running && lab.speed) lines.push(`slow motion 1 : ${Math.max(1, Math.round(1 / Math.max(1e-9, lab.speed.achieved)))}`);
  return lines;
}

let lastTraces = 0, lastSpectra = 0, lastSpeed = 0, frames = 0, lastCount = 0;

function frame(now) {
  requestAnimationFrame(frame);
  if (now - lastCount > 1000) { lab.framesPerSecond = 1000 * frames / (now - lastCount); frames = 0; lastCount = now; }
  if (!lab.picture || !lab.dirty) return;
  lab.dirty = false;
  frames += 1;
  const length = Math.hypot(...loadVector()) || 1;
  stage.draw(lab.picture, lab.displacement, { handles: lab.handles, load: lab.handles.load, direction: loadVector().map((v) => v / length), caption: caption() });
  if (lab.running) followed();
  if (!lab.frozen && now - lastTraces > 60) { lastTraces = now; drawTraces(); }
  // One after the other, so that no picture waits for both; both where a control was turned.
  if (!lab.frozen && now - lastSpectra > 250) {
    drawSpectra(lastSpectra === 0 ? "both" : lab.turned ? "envelope" : "spectrum");
    lab.turned = !lab.turned;
    lastSpectra = now;
    showNumbers();
  }
  // Words make the browser lay the page out anew: twice a second is as often as they can be read.
  if (lab.running && now - lastSpeed < 500) return;
  lastSpeed = now;
  $("speed").textContent = lab.running && lab.speed ? `${shown(1000 * lab.speed.achieved)} ms of the bearing a second (${shown(1000 * lab.speed.possible)} possible), ${Math.round(lab.framesPerSecond || 0)} pictures a second` : lab.running ? "" : "paused";
}

// ---- start

function ready() {
  $("incomplete").hidden = true;
  lab.ready = true;
  const id = decodeURIComponent(location.hash.slice(1));
  if (PRESETS.some((preset) => preset.id === id)) takePreset(id);
  else { if (id) trouble(`There is no setting “${id}”: ${PRESETS.map((preset) => preset.id).join(", ")} are there.`); run(true); }
}

function listen() {
  const on = sound.playing;
  if (on) sound.stop();
  else if (!sound.play(acceleration(lab.record.size), 1 / lab.facts.interval)) { trouble("There is not enough of the signal to listen to yet: let the bearing run for some milliseconds."); return; }
  $("listen").setAttribute("aria-pressed", String(!on));
  $("listen").textContent = on ? "Listen" : `Stop (a loop of ${shown(lab.record.count * lab.facts.interval, "s")} at true pitch)`;
}

const sound = new Sound();

function connect() {
  $("run").addEventListener("click", () => run(!lab.running));
  $("restart").addEventListener("click", () => { trouble(""); lab.engine.send({ task: "restart" }); run(true); });
  $("slow").addEventListener("change", () => run(true));
  $("exaggeration").addEventListener("change", () => { stage.exaggeration = Number($("exaggeration").value); lab.dirty = true; });
  $("freeze").addEventListener("click", () => { lab.frozen = !lab.frozen; $("freeze").setAttribute("aria-pressed", String(lab.frozen)); });
  $("listen").addEventListener("click", listen);
  $("check").addEventListener("click", check);
  $("roller").addEventListener("change", () => {
    const n = Number($("roller").value);
    if (Number.isInteger(n) && n >= 1 && n <= lab.facts.rollers) watch(n - 1);
    else { trouble(inWords(`Roller ${$("roller").value}: must be a whole number between 1 and ${lab.facts.rollers}.`)); $("roller").value = lab.handles.roller + 1; }
  });
  for (const id of ["component", "at-tone", "span", "reach", "low", "high"]) $(id).addEventListener("change", () => { lastTraces = lastSpectra = 0; lab.dirty = true; });
  $("bearing").addEventListener("change", () => { open(Number($("bearing").value)).catch((error) => trouble(error.message)); });
  addEventListener("hashchange", () => takePreset(decodeURIComponent(location.hash.slice(1))));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { forgetColours(); lab.dirty = true; lastTraces = lastSpectra = 0; });
  addEventListener("resize", () => { lab.dirty = true; lastTraces = lastSpectra = 0; });
  const name = () => `${lab.facts.name}-lab`;
  $("csv").addEventListener("click", () => {
    const n = Math.min(lab.record.count, 65536), names = ["time_s", "acceleration_x_m_s2", "acceleration_y_m_s2", "outer_force_on_watched_roller_n", "inner_force_on_watched_roller_n", "force_on_outer_ring_x_n", "force_on_outer_ring_y_n", "orbit_x_m", "orbit_y_m", "largest_outer_force_n"];
    save(`${name()}.csv`, csv(names, names.map((_, c) => lab.record.last(c, n))), "text/csv");
  });
  $("png").addEventListener("click", async () => {
    const parts = ["stage", "inset", "trace", "force", "spectrum", "envelope", "orbit"].map((id) => ({ canvas: $(id), name: $(id).getAttribute("aria-label").split(". ")[0] }));
    save(`${name()}.png`, await poster(parts, `${lab.facts.title}: ${$("words").textContent.slice(0, 110)}…`, colourOf("paper"), colourOf("ink")), "image/png");
  });
  $("ron").addEventListener("click", () => save(`${name()}.ron`, sceneText(lab.facts, lab.scene, lab.handles), "text/plain"));
}

async function check() {
  try {
    const [forces, row] = [await unpack(`reference-${lab.opened}`), await unpack(`states-${lab.opened}`)], states = [];
    for (let at = 0; at + 4 <= row.length;) {
      const long = new DataView(row.buffer, row.byteOffset + at, 4).getUint32(0, true);
      states.push(row.slice(at + 4, at + 4 + long));
      at += 4 + long;
    }
    lab.engine.send({ task: "check", reference: new Float64Array(forces.buffer), states });
    $("checked").textContent = "…";
  } catch (error) { trouble(error.message); }
}

async function begin() {
  // For programs that read more than the page shows, and for its tests.
  window.stribeckLab = lab;
  const lacks = missing();
  if (lacks) { $("incomplete").hidden = true; trouble(lacks); return; }
  try {
    lab.all = JSON.parse(elementText("facts"));
    const bytes = await unpack("module");
    lab.engine = startEngine(receive, !new URLSearchParams(location.search).has("alone"));
    lab.engine.send({ task: "module", bytes });
    $("bearing").replaceChildren(...lab.all.bearings.map((b, n) => Object.assign(document.createElement("option"), { value: n, textContent: b.title })));
    $("bearing-label").hidden = lab.all.bearings.length < 2;
    $("about").textContent = `Stribeck ${lab.all.version}. The bearing is the reduced model: rings in their natural modes, rollers rigid with the facets that they are meshed with, contact with local compliance, cage, oil and friction. Nothing is fetched from a network.`;
    collectWritten();
    buildPresets();
    connect();
    requestAnimationFrame(frame);
    await open(0);
  } catch (error) { $("incomplete").hidden = true; trouble(error.message); }
}

begin();
