// The bearing to scale, and the spall magnified.
import { sized } from "./plots.js";
import { colourOf, shown } from "./words.js";

const TAU = 2 * Math.PI;

// From a light to a full load: a hue that also a colour-blind eye follows by its lightness.
function loadColour(share) {
  const stops = [[120, 170, 215], [70, 130, 190], [235, 150, 60], [200, 40, 40]];
  const at = Math.max(0, Math.min(1, share)) * (stops.length - 1), i = Math.min(stops.length - 2, Math.floor(at)), t = at - i;
  return `rgb(${stops[i].map((v, k) => Math.round(v + t * (stops[i + 1][k] - v))).join(",")})`;
}

// A picture of the module in words.
export function readPicture(numbers, layout) {
  const [time, shaft, cageX, cageY, cageAngle, seatX, seatY, kinetic, strain, contact, friction, damping, contactDamping, film, external, drive, imbalance, step] = numbers;
  const rollers = [];
  for (let at = layout.beforeRollers; at + layout.perRoller <= numbers.length; at += layout.perRoller) {
    const [x, y, spin, ox, oy, ix, iy, cx, cy, filmOuter, filmInner] = numbers.subarray(at, at + layout.perRoller);
    rollers.push({ x, y, spin, outer: Math.hypot(ox, oy), inner: Math.hypot(ix, iy), cage: Math.hypot(cx, cy), films: [filmOuter, filmInner] });
  }
  return { time, shaft, cage: { x: cageX, y: cageY, angle: cageAngle }, seat: [seatX, seatY], rollers, step,
    energies: { kinetic, strain, contact, friction, damping, contactDamping, film, external, drive, imbalance } };
}

// An outline as a path that is drawn again and again.
function closed(outline) {
  const path = new Path2D();
  for (let i = 0; i < outline.length; i += 2) if (i) path.lineTo(outline[i], outline[i + 1]); else path.moveTo(outline[i], outline[i + 1]);
  path.closePath();
  return path;
}

export class Stage {
  constructor(canvas, inset, { onSensor, onRoller, onKey }) {
    Object.assign(this, { canvas, inset, exaggeration: 0 });
    let dragging = false;
    const place = (event) => [(event.offsetX - this.cx) / this.scale, (this.cy - event.offsetY) / this.scale];
    const sensorAt = (deg) => onSensor(((deg % 360) + 360) % 360), towards = ([x, y]) => sensorAt(Math.atan2(y, x) * 360 / TAU);
    canvas.addEventListener("pointerdown", (event) => {
      const at = place(event), radius = Math.hypot(...at), ring = this.facts.outer + this.facts.outerThickness;
      if (radius > this.facts.outer && radius < ring * 1.25) { dragging = true; canvas.setPointerCapture(event.pointerId); towards(at); return; }
      const near = this.picture.rollers.findIndex((r) => Math.hypot(r.x - at[0], r.y - at[1]) < this.facts.roller);
      if (near >= 0) onRoller(near);
    });
    canvas.addEventListener("pointermove", (event) => { if (dragging) towards(place(event)); });
    canvas.addEventListener("pointerup", () => { dragging = false; });
    // Arrows: the sensor around the ring, the watched roller to its neighbours.
    canvas.tabIndex = 0;
    canvas.addEventListener("keydown", (event) => {
      const [round, next] = [{ ArrowLeft: 15, ArrowRight: -15 }[event.key], { ArrowUp: 1, ArrowDown: -1 }[event.key]], count = this.facts.rollers;
      if (!round && !next) return;
      event.preventDefault();
      if (round) sensorAt(this.facts.sensors[this.handles.sensor].deg + round);
      else onRoller((this.handles.roller + next + count) % count);
      onKey();
    });
  }

  open(facts) { this.facts = facts; this.largest = 0; }

  still(outlines) {
    this.outlines = outlines;
    this.largest = 0;
    this.paths = { inner: closed(outlines.inner), roller: closed(outlines.roller) };
  }

  draw(picture, displacement, { handles, load, direction, caption }) {
    Object.assign(this, { picture, displacement, handles, load, direction, caption });
    if (!this.facts || !this.outlines) return;
    this.largest = Math.max(this.largest * 0.999, ...picture.rollers.map((r) => r.outer), 1e-9);
    this.drawStage();
    this.drawInset();
  }

  drawStage() {
    const [c, wide, high] = sized(this.canvas), { facts, picture } = this;
    const ring = facts.outer + facts.outerThickness, housing = facts.housing;
    const above = { adapter: housing.height, pedestal: Math.max(0, (housing.top || 0) - ring) }[housing.kind] ?? 0.18 * ring;
    const below = housing.kind === "pedestal" ? Math.max(0, housing.base - ring) : 0.18 * ring;
    const tall = 2 * ring + above + below, broad = Math.max(2.36 * ring, housing.width || 0);
    this.scale = Math.min((high - 56) / tall, (wide - 12) / broad);
    this.cx = wide / 2;
    this.cy = 48 + (ring + above) * this.scale;
    c.save();
    c.translate(this.cx, this.cy);
    c.scale(this.scale, -this.scale);
    c.lineWidth = 1 / this.scale;
    this.drawHousing(c, ring);
    this.drawRings(c, ring);
    this.drawCage(c);
    picture.rollers.forEach((roller, n) => this.drawRoller(c, roller, n));
    this.drawBars(c);
    this.drawSensor(c, ring);
    c.restore();
    this.drawLoad(c, ring);
    c.fillStyle = colourOf("faint");
    c.font = "12px system-ui, sans-serif";
    c.textAlign = "left";
    c.textBaseline = "bottom";
    this.caption.forEach((line, i) => c.fillText(line, 8, high - 8 - 15 * (this.caption.length - 1 - i)));
  }

  drawHousing(c, ring) {
    const { housing } = this.facts;
    c.fillStyle = colourOf("housing");
    c.strokeStyle = colourOf("steel-edge");
    c.beginPath();
    if (housing.kind === "adapter") {
      const half = housing.width / 2, top = ring + housing.height, from = Math.acos(Math.min(1, half / ring));
      c.moveTo(half, top);
      c.lineTo(half, ring * Math.sin(from));
      c.arc(0, 0, ring, from, Math.PI - from);
      c.lineTo(-half, top);
      c.closePath();
    } else if (housing.kind === "pedestal") {
      c.rect(-housing.width / 2, -housing.base, housing.width, housing.base + housing.top);
    } else if (housing.kind === "springs") {
      for (let i = 0; i < 48; i += 1) {
        const a = TAU * i / 48;
        for (let k = 0; k <= 6; k += 1) {
          const r = ring * (1.01 + 0.018 * k), t = a + (k % 2 ? 0.02 : -0.02) * (k > 0 && k < 6 ? 1 : 0);
          if (k) c.lineTo(r * Math.cos(t), r * Math.sin(t)); else c.moveTo(r * Math.cos(t), r * Math.sin(t));
        }
      }
    } else {
      c.arc(0, 0, 1.12 * ring, 0, TAU);
    }
    if (housing.kind !== "springs") c.fill();
    c.stroke();
  }

  // The raceway as it is meshed, and moved as far as it is exaggerated.
  drawRings(c, ring) {
    const { outer } = this.outlines, { facts, displacement } = this;
    const moved = this.exaggeration > 0 && displacement.length === outer.length;
    const path = (grow) => {
      for (let i = 0; i < outer.length; i += 2) {
        const radius = Math.hypot(outer[i], outer[i + 1]), far = grow ? ring / radius : 1;
        const x = outer[i] * far + (moved ? this.exaggeration * displacement[i] : 0);
        const y = outer[i + 1] * far + (moved ? this.exaggeration * displacement[i + 1] : 0);
        if (i) c.lineTo(x, y); else c.moveTo(x, y);
      }
      c.closePath();
    };
    c.fillStyle = colourOf("steel");
    c.strokeStyle = colourOf("steel-edge");
    c.beginPath();
    path(true);
    path(false);
    c.fill("evenodd");
    c.stroke();
    c.save();
    c.rotate(this.picture.shaft);
    const bore = Math.max(0.2 * facts.inner, facts.inner - facts.innerThickness), track = new Path2D(this.paths.inner);
    track.moveTo(bore, 0);
    track.arc(0, 0, bore, 0, TAU);
    c.fill(track, "evenodd");
    c.stroke(track);
    c.fillStyle = colourOf("steel-edge");
    c.beginPath();
    c.arc(0.5 * (bore + facts.inner), 0, 0.12 * facts.innerThickness, 0, TAU);
    c.fill();
    c.restore();
    this.markSpall(c);
  }

  markSpall(c) {
    const spall = this.spall();
    if (!spall) return;
    const radius = spall.inner ? this.facts.inner : this.facts.outer, half = 0.5 * spall.length / radius;
    c.strokeStyle = colourOf("c-red");
    c.lineWidth = 3 / this.scale;
    c.beginPath();
    c.arc(0, 0, radius + (spall.inner ? -1 : 1) * 1.5 / this.scale, spall.angle - half, spall.angle + half);
    c.stroke();
    c.lineWidth = 1 / this.scale;
  }

  spall() {
    const { spallRing, spallAngle, spallLength, spallDepth } = this.handles;
    if (!spallRing) return null;
    const inner = spallRing > 1, angle = spallAngle * TAU / 360 + (inner ? this.picture.shaft : 0);
    return { inner, angle, length: spallLength / 1000, depth: spallDepth / 1000 };
  }

  drawCage(c) {
    const { cage } = this.facts;
    if (!cage) return;
    const { x, y, angle } = this.picture.cage, [low, high] = [Math.min(...cage.radii), Math.max(...cage.radii)];
    const path = this.facts.outer - this.facts.roller, gap = (this.facts.roller * 0.98) / path;
    c.fillStyle = colourOf("cage");
    const { pockets } = cage, sorted = [...pockets].sort((a, b) => a - b);
    sorted.forEach((from, i) => {
      const to = i + 1 < sorted.length ? sorted[i + 1] : sorted[0] + TAU;
      if (to - from < 2 * gap) return;
      c.beginPath();
      c.arc(x, y, high, angle + from + gap, angle + to - gap);
      c.arc(x, y, low, angle + to - gap, angle + from + gap, true);
      c.closePath();
      c.fill();
    });
  }

  drawRoller(c, roller, n) {
    const { outlines, facts } = this, share = roller.outer / this.largest, outline = this.paths.roller;
    c.save();
    c.translate(roller.x, roller.y);
    c.rotate(roller.spin + outlines.vertexAngles[n]);
    c.fillStyle = colourOf("roller");
    c.strokeStyle = n === this.handles.roller ? colourOf("link") : colourOf("steel-edge");
    c.lineWidth = (n === this.handles.roller ? 2.5 : 1) / this.scale;
    c.fill(outline);
    if (share > 0.02) { c.globalAlpha = 0.25 + 0.6 * share; c.fillStyle = loadColour(share); c.fill(outline); c.globalAlpha = 1; }
    c.stroke(outline);
    c.lineWidth = 1.5 / this.scale;
    c.strokeStyle = colourOf("steel-edge");
    c.beginPath();
    c.moveTo(-0.55 * facts.roller, 0);
    c.lineTo(0.55 * facts.roller, 0);
    c.moveTo(0, 0);
    c.lineTo(0, 0.55 * facts.roller);
    c.stroke();
    c.restore();
  }

  // Forces on the raceway, outwards from where each roller presses.
  drawBars(c) {
    const { facts, picture } = this, longest = Math.max(1.6 * facts.outerThickness, 0.2 * facts.outer);
    for (const roller of picture.rollers) {
      const share = roller.outer / this.largest, angle = Math.atan2(roller.y, roller.x);
      if (share < 0.003) continue;
      const wide = Math.max(0.3 * facts.roller, 3 / this.scale);
      c.save();
      c.rotate(angle);
      c.fillStyle = loadColour(share);
      c.fillRect(facts.outer, -wide / 2, longest * share, wide);
      c.restore();
    }
  }

  drawSensor(c, ring) {
    const sensor = this.facts.sensors[this.handles.sensor];
    c.save();
    c.rotate(sensor.deg * TAU / 360);
    const size = 9 / this.scale;
    c.fillStyle = colourOf("c-green");
    c.fillRect(ring, -size / 2, 1.3 * size, size);
    c.strokeStyle = colourOf("paper");
    c.lineWidth = 1.5 / this.scale;
    c.strokeRect(ring, -size / 2, 1.3 * size, size);
    c.restore();
  }

  drawLoad(c, ring) {
    const [x, y] = this.direction, { housing } = this.facts;
    const reach = (ring + (y < 0 && housing.kind === "adapter" ? housing.height : 0.2 * ring)) * this.scale;
    const tip = [this.cx - x * (reach + 2), this.cy + y * (reach + 2)], tail = [tip[0] - x * 26, tip[1] + y * 26];
    c.strokeStyle = c.fillStyle = colourOf("c-purple");
    c.lineWidth = 3;
    c.beginPath();
    c.moveTo(...tail);
    c.lineTo(tip[0] - x * 8, tip[1] + y * 8);
    c.stroke();
    c.beginPath();
    c.moveTo(...tip);
    c.lineTo(tip[0] - x * 10 + y * 6, tip[1] + y * 10 + x * 6);
    c.lineTo(tip[0] - x * 10 - y * 6, tip[1] + y * 10 - x * 6);
    c.fill();
    c.font = "600 13px system-ui, sans-serif";
    c.textAlign = "left";
    c.textBaseline = "middle";
    c.fillText(shown(this.load, "N"), tail[0] + 10, tail[1] + 6);
  }

  // The raceway about the spall, stretched across it: outside is up on the outer ring, inside on the inner one.
  drawInset() {
    const [c, wide, high] = sized(this.inset), { facts, outlines, picture } = this;
    const spall = this.spall(), watched = picture.rollers[this.handles.roller];
    const inner = spall ? spall.inner : false, base = inner ? facts.inner : facts.outer;
    const angle = spall ? spall.angle : Math.atan2(watched.y, watched.x);
    const depth = spall ? spall.depth : 0, half = spall ? 0.5 * spall.length : 0.25 * facts.roller;
    const span = Math.max(1.5 * half + 0.15 * facts.roller, 0.3 * facts.roller);
    const room = Math.max(1.5 * depth, 0.006 * facts.roller), below = 2.2 * room;
    const outwards = inner ? -1 : 1, sx = wide / (2 * span), sy = (high - 24) / (room + below);
    const turned = inner ? picture.shaft : 0;
    const px = (a) => wide / 2 - outwards * Math.sin(a - angle) * base * sx;
    const py = (r) => 20 + (room - outwards * (r - base)) * sy;
    const near = (a) => Math.abs(((a - angle + Math.PI) % TAU + TAU) % TAU - Math.PI) * base < 1.6 * span;
    const track = inner ? outlines.inner : outlines.outer, n = track.length / 2;
    const points = [];
    for (let i = 0; i < n; i += 1) {
      const a = Math.atan2(track[2 * i + 1], track[2 * i]) + turned;
      const more = !inner && this.displacement.length === track.length ? this.displacement[2 * i] * Math.cos(a) + this.displacement[2 * i + 1] * Math.sin(a) : 0;
      if (near(a)) points.push([((a - angle + Math.PI) % TAU + TAU) % TAU - Math.PI, Math.hypot(track[2 * i], track[2 * i + 1]) + more]);
    }
    // Walls have two vertices at one angle: the order of the outline is kept beside that of the angle.
    const order = points.map((p, i) => [p, i]).sort((p, q) => p[0][0] - q[0][0] || p[1] - q[1]).map(([p]) => p);
    c.fillStyle = colourOf("steel");
    c.strokeStyle = colourOf("steel-edge");
    c.lineWidth = 1.5;
    c.beginPath();
    order.forEach(([a, r], i) => (i ? c.lineTo(px(angle + a), py(r)) : c.moveTo(px(angle + a), py(r))));
    c.stroke();
    const ends = [order[0], order[order.length - 1]];
    if (ends[0]) { c.lineTo(px(angle + ends[1][0]), -20); c.lineTo(px(angle + ends[0][0]), -20); c.closePath(); c.fill(); }
    if (facts.facets[inner ? "inner" : "outer"] < 1e5) {
      c.fillStyle = colourOf("steel-edge");
      for (const [a, r] of order) c.fillRect(px(angle + a) - 1, py(r) - 1, 2, 2);
    }
    picture.rollers.forEach((roller, i) => {
      if (!near(Math.atan2(roller.y, roller.x))) return;
      const turn = roller.spin + outlines.vertexAngles[i], count = outlines.roller.length / 2;
      c.beginPath();
      let drawn = 0;
      const outline = [];
      for (let k = 0; k < count; k += 1) {
        const [vx, vy] = [outlines.roller[2 * k], outlines.roller[2 * k + 1]];
        const x = roller.x + vx * Math.cos(turn) - vy * Math.sin(turn), y = roller.y + vx * Math.sin(turn) + vy * Math.cos(turn);
        const radius = Math.hypot(x, y), a = Math.atan2(y, x);
        if (outwards * (radius - base) > -4 * below) outline.push([((a - angle + Math.PI) % TAU + TAU) % TAU - Math.PI, radius]);
      }
      outline.sort((p, q) => p[0] - q[0]);
      for (const [a, r] of outline) { if (drawn) c.lineTo(px(angle + a), py(r)); else c.moveTo(px(angle + a), py(r)); drawn += 1; }
      if (drawn < 2) return;
      c.globalAlpha = 0.9;
      c.strokeStyle = i === this.handles.roller ? colourOf("link") : colourOf("ink");
      c.lineWidth = i === this.handles.roller ? 2.2 : 1.4;
      c.stroke();
      c.fillStyle = colourOf("steel-edge");
      for (const [a, r] of outline) c.fillRect(px(angle + a) - 1.5, py(r) - 1.5, 3, 3);
      c.globalAlpha = 1;
      const force = inner ? roller.inner : roller.outer;
      c.fillStyle = loadColour(roller.outer / this.largest);
      const middle = px(Math.atan2(roller.y, roller.x));
      const bar = Math.min(1, force / this.largest) * 0.42 * high;
      c.fillRect(middle - 4, high - 4 - bar, 8, bar);
      c.font = "600 12px system-ui, sans-serif";
      c.textAlign = "center";
      c.textBaseline = "bottom";
      if (middle > 20 && middle < wide - 20) c.fillText(shown(force, "N"), middle, high - 8 - bar);
    });
    c.fillStyle = colourOf("faint");
    c.font = "11px system-ui, sans-serif";
    c.textAlign = "left";
    c.textBaseline = "top";
    const magnified = sy / sx;
    c.fillText(`${spall ? `the spall on the ${inner ? "inner" : "outer"} raceway` : `under the watched ${this.facts.balls ? "ball" : "roller"}`}, heights × ${magnified.toFixed(0)}; ${shown(2 * span, "m")} wide`, 6, 4);
  }
}
