// Numbers and lists as a person reads them.

export const G = 9.80665;

// Three digits, with a prefix where the unit takes one.
export function shown(value, unit = "") {
  if (!Number.isFinite(value)) return "–";
  if (value === 0) return `0 ${unit}`.trim();
  const prefixes = [[1e9, "G"], [1e6, "M"], [1e3, "k"], [1, ""], [1e-3, "m"], [1e-6, "µ"], [1e-9, "n"]];
  const plain = !["m", "N", "s", "J", "Hz", "W"].includes(unit);
  const [factor, prefix] = plain ? [1, ""] : prefixes.find(([f]) => Math.abs(value) >= f * 0.9995) || [1e-12, "p"];
  const scaled = value / factor, size = Math.abs(scaled);
  const digits = size >= 99.95 ? 0 : size >= 9.995 ? 1 : size >= 0.0995 ? 2 : 4;
  return `${scaled.toFixed(digits)} ${prefix}${unit}`.trim();
}

// Colours of the page by name, asked for once: the browser takes longer to look one up than to draw a line.
const colours = new Map();

export function colourOf(name) {
  if (!colours.has(name)) colours.set(name, getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim());
  return colours.get(name);
}

// A page that turned from light to dark has others.
export const forgetColours = () => colours.clear();

// Texts are written for rollers; those of a bearing with balls say balls.
export function named(text, facts) {
  if (!facts || !facts.balls) return text;
  return text.replace(/\b([rR])oller(s?)\b/g, (_, first, many) => (first === "R" ? "Ball" : "ball") + many);
}

// Frequencies of the bearing at a speed [rpm]: those of its facets too.
export function frequencies(facts, rpm, facets, arcs) {
  const relative = Math.abs(rpm - facts.outerRpm), at = facts.hzPerRpm;
  const of = (perRpm) => relative * perRpm;
  return {
    shaft: Math.abs(rpm) / 60, ftf: of(at.ftf), bpfo: of(at.bpfo), bpfi: of(at.bpfi), twoBsf: 2 * of(at.bsf),
    spin: of(at.spin), facets: arcs ? 0 : facets * of(at.spin),
  };
}
