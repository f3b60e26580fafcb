// Plots on canvas: lines by their least and largest value in a column, ticks, markers, a cursor, zoom.
import { colourOf, shown } from "./words.js";

// The canvas as large as the screen has pixels for it, empty; and its size in the page.
export function sized(canvas) {
  const ratio = window.devicePixelRatio || 1, [wide, high] = [canvas.clientWidth, canvas.clientHeight];
  if (canvas.width !== Math.round(wide * ratio) || canvas.height !== Math.round(high * ratio)) {
    canvas.width = Math.round(wide * ratio);
    canvas.height = Math.round(high * ratio);
  }
  const c = canvas.getContext("2d");
  c.setTransform(ratio, 0, 0, ratio, 0, 0);
  c.clearRect(0, 0, wide, high);
  return [c, wide, high];
}

// Steps of 1, 2 or 5 times a power of ten.
function ticks(low, high, about) {
  const raw = (high - low) / about, power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((k) => k * power).find((s) => s >= raw * 0.999);
  const first = Math.ceil(low / step - 1e-9), count = Math.floor(high / step + 1e-9) - first;
  return Array.from({ length: Math.max(0, Math.min(30, count + 1)) }, (_, i) => (first + i) * step);
}

export class Plot {
  // `x` and `y` are { name, unit, scale }: scale makes what is drawn of what is given.
  constructor(canvas, { x, y, log = false, square = false }) {
    Object.assign(this, { canvas, x, y, log, square, series: [], markers: [], window: null, cursor: null, note: "" });
    // Where there is a cursor, arrow keys move it: for a screen reader the plot is a slider whose value is what it reads.
    if (!square) {
      canvas.tabIndex = 0;
      for (const [name, value] of [["role", "slider"], ["aria-valuemin", 0], ["aria-valuemax", 1], ["aria-valuenow", 0], ["aria-valuetext", "no cursor"]]) canvas.setAttribute(name, value);
      canvas.setAttribute("aria-description", "arrow keys move the cursor, plus and minus zoom, 0 shows all");
    }
    canvas.addEventListener("pointermove", (event) => { this.cursor = event.offsetX; this.draw(); });
    canvas.addEventListener("pointerleave", () => { this.cursor = null; this.draw(); });
    canvas.addEventListener("dblclick", () => { this.window = null; this.draw(); });
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      const at = this.atPixel(event.offsetX);
      this.zoom(at, event.deltaY < 0 ? 0.8 : 1.25);
    }, { passive: false });
    canvas.addEventListener("keydown", (event) => this.key(event));
  }

  key(event) {
    const middle = 0.5 * (this.seen()[0] + this.seen()[1]);
    const keys = {
      "+": () => this.zoom(middle, 0.8), "-": () => this.zoom(middle, 1.25), 0: () => { this.window = null; },
      ArrowLeft: () => { this.cursor = Math.max(this.left || 0, (this.cursor ?? this.canvas.clientWidth / 2) - 4); },
      ArrowRight: () => { this.cursor = Math.min(this.canvas.clientWidth, (this.cursor ?? this.canvas.clientWidth / 2) + 4); },
    };
    if (!keys[event.key]) return;
    event.preventDefault();
    keys[event.key]();
    this.draw();
    this.tell();
  }

  // What the cursor reads, for who cannot see it.
  tell() {
    if (this.cursor === null || !(this.right > this.left)) return;
    this.canvas.setAttribute("aria-valuenow", Math.min(1, Math.max(0, (this.cursor - this.left) / (this.right - this.left))).toFixed(3));
    this.canvas.setAttribute("aria-valuetext", this.reading().join(", "));
  }

  // The place of the cursor, and the value of each line there.
  reading() {
    const at = this.atPixel(this.cursor), words = [`${shown(at, this.x.base || this.x.unit)}`];
    for (const s of this.series.filter((one) => !one.x)) {
      const i = Math.round((at - s.x0) / s.dx);
      if (i >= 0 && i < s.y.length) words.push(`${s.name ? `${s.name} ` : ""}${shown(s.y[i] * (this.y.scale || 1), this.y.unit)}`);
    }
    return words;
  }

  zoom(at, by) {
    const [low, high] = this.seen(), [least, most] = this.range;
    const next = [Math.max(least, at - (at - low) * by), Math.min(most, at + (high - at) * by)];
    this.window = next[0] <= least && next[1] >= most ? null : next;
    this.draw();
  }

  seen() { return this.window && !this.square ? this.window : this.range || [0, 1]; }

  atPixel(px) {
    const [low, high] = this.seen();
    return low + (px - this.left) / (this.right - this.left) * (high - low);
  }

  // Series are { name, colour, y, x0, dx } or { …, x, y }; markers { at, name, colour }.
  show({ series, range, yRange, markers = [], note = "" }) {
    Object.assign(this, { series, range, yRange, markers, note });
    this.draw();
  }

  draw() {
    const { canvas } = this;
    const [wide, high] = [canvas.clientWidth, canvas.clientHeight];
    if (!wide || !high || !this.range) return;
    const [c] = sized(canvas);
    c.font = "11px system-ui, sans-serif";
    Object.assign(this, { left: 52, right: wide - 18, top: 16, bottom: high - 30 });
    const [x0, x1] = this.seen(), [y0, y1] = this.yRange || this.fitted(x0, x1);
    const fy = this.log ? Math.log10 : (v) => v, [f0, f1] = [fy(y0), fy(y1)];
    const px = (v) => this.left + (v - x0) / (x1 - x0) * (this.right - this.left);
    const py = (v) => this.bottom - (fy(v) - f0) / (f1 - f0) * (this.bottom - this.top);
    this.axes(c, [x0, x1], [y0, y1], px, py, wide);
    c.save();
    c.beginPath();
    c.rect(this.left, this.top - 2, this.right - this.left, this.bottom - this.top + 4);
    c.clip();
    this.drawMarkers(c, px, [x0, x1]);
    for (const s of this.series) this.line(c, s, px, py, [x0, x1], y0);
    c.restore();
    this.labels(c, px, [x0, x1]);
    this.drawCursor(c, px, wide);
  }

  fitted(x0, x1) {
    let [low, high] = [Infinity, -Infinity];
    for (const s of this.series) {
      const [from, to] = s.x ? [0, s.y.length - 1] : [Math.max(0, Math.floor((x0 - s.x0) / s.dx)), Math.min(s.y.length - 1, Math.ceil((x1 - s.x0) / s.dx))];
      for (let i = from; i <= to; i += 1) { const v = s.y[i]; if (v < low) low = v; if (v > high) high = v; }
    }
    if (!(high > low)) [low, high] = this.log ? [1e-6, 1] : [-1, 1];
    if (this.log) return [Math.max(high * 1e-5, low, 1e-12), high * 2];
    const room = 0.06 * (high - low);
    return [low - room, high + room];
  }

  axes(c, [x0, x1], [y0, y1], px, py, wide) {
    c.strokeStyle = colourOf("grid");
    c.fillStyle = colourOf("faint");
    c.lineWidth = 1;
    c.textAlign = "center";
    c.textBaseline = "top";
    const [sx, sy] = [this.x.scale || 1, this.y.scale || 1];
    const number = (v, step) => (Math.abs(v) < 1e-12 ? "0" : Math.abs(step) >= 1 ? v.toFixed(0) : v.toFixed(Math.min(6, Math.ceil(-Math.log10(Math.abs(step)) - 1e-9))));
    const line = (ax, ay, bx, by) => { c.beginPath(); c.moveTo(ax, ay); c.lineTo(bx, by); c.stroke(); };
    const tx = ticks(x0 * sx, x1 * sx, Math.max(2, wide / 90));
    for (const t of tx) { const at = px(t / sx); line(at, this.top, at, this.bottom); c.fillText(number(t, tx[1] - tx[0] || 1), at, this.bottom + 4); }
    c.textAlign = "right";
    c.textBaseline = "middle";
    if (this.log) {
      for (let e = Math.ceil(Math.log10(y0 * sy)); e <= Math.log10(y1 * sy); e += 1) {
        const at = py(10 ** e / sy);
        line(this.left, at, this.right, at);
        c.fillText(e >= -2 && e <= 4 ? String(Number((10 ** e).toPrecision(1))) : `1e${e}`, this.left - 5, at);
      }
    } else {
      const ty = ticks(y0 * sy, y1 * sy, Math.max(2, (this.bottom - this.top) / 32));
      for (const t of ty) { const at = py(t / sy); line(this.left, at, this.right, at); c.fillText(number(t, ty[1] - ty[0] || 1), this.left - 5, at); }
    }
    c.textAlign = "right";
    c.textBaseline = "bottom";
    c.fillText(`${this.x.name}${this.x.unit ? ` [${this.x.unit}]` : ""}`, this.right, this.bottom + 29);
    c.textAlign = "left";
    c.textBaseline = "top";
    c.fillText(`${this.y.name}${this.y.unit ? ` [${this.y.unit}]` : ""}`, 2, 0);
  }

  // Least and largest value in each column of pixels.
  line(c, s, px, py, [x0, x1], floor) {
    c.strokeStyle = s.colour;
    c.lineWidth = s.width || 1.2;
    c.globalAlpha = s.alpha || 1;
    c.beginPath();
    if (s.x) {
      for (let i = 0; i < s.y.length; i += 1) { const at = [px(s.x[i]), py(s.y[i])]; if (i) c.lineTo(...at); else c.moveTo(...at); }
    } else {
      const from = Math.max(0, Math.floor((x0 - s.x0) / s.dx)), to = Math.min(s.y.length - 1, Math.ceil((x1 - s.x0) / s.dx));
      const perColumn = (to - from) / Math.max(1, this.right - this.left);
      const value = (v) => (this.log ? Math.max(v, floor * 0.5) : v);
      if (perColumn < 2) {
        for (let i = from; i <= to; i += 1) { const at = [px(s.x0 + i * s.dx), py(value(s.y[i]))]; if (i > from) c.lineTo(...at); else c.moveTo(...at); }
      } else {
        for (let first = from; first <= to; first += perColumn) {
          let [low, high] = [Infinity, -Infinity];
          for (let i = Math.floor(first); i <= Math.min(to, first + perColumn); i += 1) { if (s.y[i] < low) low = s.y[i]; if (s.y[i] > high) high = s.y[i]; }
          const at = px(s.x0 + first * s.dx);
          c.lineTo(at, py(value(low)));
          c.lineTo(at, py(value(high)));
        }
      }
    }
    c.stroke();
    if (s.dot && s.y.length) { c.fillStyle = s.colour; c.beginPath(); c.arc(px(s.x[s.x.length - 1]), py(s.y[s.y.length - 1]), 3.5, 0, 7); c.fill(); }
    c.globalAlpha = 1;
  }

  drawMarkers(c, px, [x0, x1]) {
    for (const m of this.markers.filter((marker) => marker.at > x0 && marker.at < x1)) {
      c.strokeStyle = m.colour;
      c.globalAlpha = m.weak ? 0.35 : 0.75;
      c.setLineDash(m.weak ? [2, 4] : [5, 3]);
      c.beginPath();
      c.moveTo(px(m.at), this.top);
      c.lineTo(px(m.at), this.bottom);
      c.stroke();
    }
    c.setLineDash([]);
    c.globalAlpha = 1;
  }

  // Names of markers, each where it covers no other.
  labels(c, px, [x0, x1]) {
    c.textBaseline = "top";
    c.textAlign = "left";
    const taken = [];
    for (const m of this.markers.filter((marker) => marker.name && marker.at > x0 && marker.at < x1)) {
      const wide = c.measureText(m.name).width + 4;
      const at = Math.min(px(m.at) + 3, this.right - wide);
      let row = 0;
      while (taken.some(([r, a, b]) => r === row && at < b && at + wide > a)) row += 1;
      if (row > 4) continue;
      taken.push([row, at, at + wide]);
      c.fillStyle = colourOf("paper");
      c.globalAlpha = 0.75;
      c.fillRect(at - 1, this.top + 12 * row, wide, 12);
      c.globalAlpha = 1;
      c.fillStyle = m.colour;
      c.fillText(m.name, at, this.top + 12 * row);
    }
    c.textAlign = "right";
    let at = this.right;
    for (const s of [...this.series].reverse().filter((one) => one.name)) {
      c.fillStyle = s.colour;
      c.fillText(s.name, at, 0);
      at -= c.measureText(s.name).width + 12;
    }
    if (this.note) { c.fillStyle = colourOf("faint"); c.fillText(this.note, at, 0); }
  }

  drawCursor(c, px) {
    if (this.cursor === null || this.square || this.cursor < this.left || this.cursor > this.right) return;
    const at = this.atPixel(this.cursor), words = this.reading();
    c.strokeStyle = colourOf("ink");
    c.globalAlpha = 0.5;
    c.beginPath();
    c.moveTo(px(at), this.top);
    c.lineTo(px(at), this.bottom);
    c.stroke();
    c.globalAlpha = 1;
    c.textAlign = this.cursor > 0.6 * this.right ? "right" : "left";
    c.textBaseline = "bottom";
    c.fillStyle = colourOf("ink");
    c.fillText(` ${words.join(", ")} `, px(at), this.bottom - 3);
  }
}
