// The bearing in slow motion: draws what trace.npy says at a time, and tells the charts which time it is.
(() => {
  "use strict";
  const TAU = 2 * Math.PI;
  const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const shorts = (text) => new Uint16Array(bytes(text).buffer);
  const theme = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const minus = (text) => text.replace("-", "−");

  const setUp = (figure) => {
    const spec = JSON.parse(figure.querySelector('script[type="application/json"]').textContent);
    const [bearing, strips] = figure.querySelectorAll("canvas");
    const play = figure.querySelector(".play"), scrubber = figure.querySelector("input[type=range]");
    const slow = figure.querySelector("select"), said = figure.querySelector("output");
    const count = spec.rollers.length, largest = spec.largest_n;
    const element = spec.element[0].toUpperCase() + spec.element.slice(1);
    const orbit = shorts(spec.orbit), spin = shorts(spec.spin), shaft = shorts(spec.shaft), ring = shorts(spec.ring);
    const cage = spec.cage && shorts(spec.cage);
    const outer = bytes(spec.outer), inner = bytes(spec.inner);
    const extremes = spec.trace && shorts(spec.trace.extremes);
    let at = spec.first, playing = false, last = 0, colours = {};
    let followed = Math.max(0, spec.rollers.findIndex((n) => spec.events.some(([, words]) => words.startsWith(`${spec.element} ${n} `))));

    const timeOf = (frame) => spec.start_s + (frame + 0.5) * spec.step_s;
    const frame = () => Math.min(spec.frames - 1, Math.max(0, Math.round(at)));
    const force = (of, n) => (of[frame() * count + n] / 255) * largest;

    // Between two angles the shorter way round.
    const angle = (of, wide, n) => {
      const rows = of.length / wide, place = at / spec.angles_every;
      const row = Math.min(rows - 1, Math.floor(place)), next = Math.min(rows - 1, row + 1);
      const a = of[row * wide + n] / 65536, b = of[next * wide + n] / 65536;
      // The last of the angles belongs to the last frame, which may come sooner.
      const span = next === rows - 1 ? spec.frames - 1 - row * spec.angles_every : spec.angles_every;
      const part = span > 0 ? Math.min(1, (at - row * spec.angles_every) / span) : 0;
      return TAU * (a + part * (b - a - Math.round(b - a)));
    };

    const size = (canvas, width, height) => {
      const ratio = devicePixelRatio || 1;
      canvas.width = Math.round(width * ratio);
      canvas.height = Math.round(height * ratio);
      canvas.style.height = height + "px";
      const ctx = canvas.getContext("2d");
      ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
      return ctx;
    };

    const kilo = (n) => (n >= 1000 ? `${+(n / 1000).toPrecision(3)} kN` : `${Math.round(n)} N`);
    const round = (x) => { const p = 10 ** Math.floor(Math.log10(x)); return [5, 2, 1].map((m) => m * p).find((v) => v <= x) || p; };

    let geometry = null;
    const drawBearing = () => {
      const side = bearing.clientWidth || 480;
      const ctx = size(bearing, side, side), r = spec.radii;
      const bar = 0.22 * r.outer_back;
      const scale = (side / 2 - 16) / (r.outer_back + bar);
      const inside = Math.max(0.1, Math.min(bar, r.inner_back - 0.12 * r.outer_back));
      geometry = { middle: side / 2, scale };
      ctx.translate(side / 2, side / 2);
      ctx.scale(scale, -scale);
      const thin = 1 / scale;
      const disc = (radius, fill) => { ctx.beginPath(); ctx.arc(0, 0, radius, 0, TAU); ctx.fillStyle = fill; ctx.fill(); };
      const annulus = (a, b, from, to, fill, line) => {
        ctx.beginPath(); ctx.arc(0, 0, b, from, to); ctx.arc(0, 0, a, to, from, true); ctx.closePath();
        if (fill) { ctx.fillStyle = fill; ctx.fill(); }
        if (line) { ctx.strokeStyle = line; ctx.lineWidth = thin; ctx.stroke(); }
      };
      disc(r.outer_back, colours.steel); disc(r.outer, colours.paper);
      disc(r.inner, colours.steel); disc(r.inner_back, colours.paper);
      ctx.strokeStyle = colours.line; ctx.lineWidth = thin;
      for (const radius of [r.outer_back, r.outer, r.inner, r.inner_back]) { ctx.beginPath(); ctx.arc(0, 0, radius, 0, TAU); ctx.stroke(); }
      // Marks on the rings show that they turn, or do not.
      const turned = { inner: angle(shaft, 1, 0), outer: angle(ring, 1, 0) };
      const tick = (a, from, to) => { ctx.beginPath(); ctx.moveTo(from * Math.cos(a), from * Math.sin(a)); ctx.lineTo(to * Math.cos(a), to * Math.sin(a)); ctx.stroke(); };
      ctx.lineWidth = 2 * thin;
      for (let k = 0; k < 4; k++) {
        ctx.strokeStyle = colours.faint;
        tick(turned.inner + k * TAU / 4, r.inner_back, 0.5 * (r.inner + r.inner_back));
        tick(turned.outer + (k + 0.5) * TAU / 4, 0.5 * (r.outer + r.outer_back), r.outer_back);
      }
      for (const spall of spec.spalls) {
        const middle = spall.angle + (spall.inner ? turned.inner : turned.outer);
        // A short spall is drawn long enough to be seen.
        const half = Math.max(spall.half_rad, 2.5 * thin / r.outer), depth = 0.03 * r.outer_back;
        annulus(spall.inner ? r.inner - depth : r.outer, spall.inner ? r.inner : r.outer + depth, middle - half, middle + half, colours.red);
      }
      if (cage && r.cage) {
        const turn = angle(cage, 1, 0), all = spec.pockets;
        all.forEach((pocket, n) => {
          const next = all[(n + 1) % all.length] + (n + 1 === all.length ? TAU : 0);
          const from = pocket + spec.pocket_half_rad + turn, to = next - spec.pocket_half_rad + turn;
          if (to > from) annulus(r.cage[0], r.cage[1], from, to, colours.cage);
        });
      }
      for (let n = 0; n < count; n++) {
        const place = angle(orbit, count, n), turn = angle(spin, count, n);
        const x = r.path * Math.cos(place), y = r.path * Math.sin(place);
        const [out, inn] = [force(outer, n), force(inner, n)];
        ctx.beginPath(); ctx.arc(x, y, r.roller, 0, TAU);
        ctx.fillStyle = colours.roller; ctx.fill();
        ctx.globalAlpha = 0.75 * Math.sqrt(Math.max(out, inn) / largest);
        ctx.fillStyle = colours.blue; ctx.fill(); ctx.globalAlpha = 1;
        ctx.strokeStyle = spec.faulty.includes(spec.rollers[n]) ? colours.red : n === followed ? colours.ink : colours.line;
        ctx.lineWidth = (n === followed ? 2.5 : 1) * thin; ctx.stroke();
        ctx.strokeStyle = colours.ink; ctx.lineWidth = 1.5 * thin;
        ctx.beginPath(); ctx.moveTo(x, y); ctx.lineTo(x + 0.85 * r.roller * Math.cos(turn), y + 0.85 * r.roller * Math.sin(turn)); ctx.stroke();
        const width = Math.max(3 * thin, 0.5 * r.roller);
        ctx.lineWidth = width;
        ctx.strokeStyle = colours.blue; if (out > 0) tick(place, r.outer_back + 2 * thin, r.outer_back + 2 * thin + bar * out / largest);
        ctx.strokeStyle = colours.orange; if (inn > 0) tick(place, r.inner_back - 2 * thin, r.inner_back - 2 * thin - inside * inn / largest);
      }
      ctx.setTransform(devicePixelRatio || 1, 0, 0, devicePixelRatio || 1, 0, 0);
      words(ctx, side, bar * scale, inside * scale);
    };

    const words = (ctx, side, bar, inside) => {
      const full = round(largest);
      ctx.font = "12px system-ui, sans-serif"; ctx.textBaseline = "middle"; ctx.textAlign = "left";
      [[colours.blue, bar, 12, "outer"], [colours.orange, inside, 28, "inner"]].forEach(([colour, length, y, what]) => {
        const long = length * full / largest;
        ctx.fillStyle = colour; ctx.fillRect(8, y - 3, long, 6);
        ctx.fillStyle = colours.ink; ctx.fillText(side < 440 ? `${what} ${kilo(full)}` : `${what} raceway, ${kilo(full)}`, 14 + long, y);
      });
      const number = spec.rollers[followed], place = angle(orbit, count, followed), r = spec.radii;
      ctx.textAlign = "center";
      // The load pushes the housing: an arrow in the middle of the bearing.
      const [lx, ly] = spec.load, c = side / 2, long = Math.min(34, 0.3 * r.inner_back * geometry.scale);
      if (long > 14) {
        ctx.strokeStyle = ctx.fillStyle = colours.ink; ctx.lineWidth = 2;
        const tip = [c + long * lx, c - long * ly];
        ctx.beginPath(); ctx.moveTo(c - long * lx, c + long * ly); ctx.lineTo(...tip); ctx.stroke();
        ctx.beginPath(); ctx.moveTo(tip[0] + 6 * lx, tip[1] - 6 * ly);
        ctx.lineTo(tip[0] - 5 * ly, tip[1] - 5 * lx); ctx.lineTo(tip[0] + 5 * ly, tip[1] + 5 * lx); ctx.fill();
        ctx.textAlign = "left"; ctx.fillText("load", c + 9, c);
        ctx.textAlign = "center";
      }
      const label = r.outer_back + 0.22 * r.outer_back * Math.min(1, force(outer, followed) / largest) + 12 / geometry.scale;
      ctx.fillStyle = colours.ink;
      ctx.fillText(String(number), c + label * geometry.scale * Math.cos(place), c - label * geometry.scale * Math.sin(place));
    };

    const drawStrips = () => {
      const width = strips.clientWidth || 480, height = 330;
      const ctx = size(strips, width, height);
      ctx.font = "12px system-ui, sans-serif"; ctx.textBaseline = "alphabetic";
      const left = 6, right = width - 6, x = (f) => left + (right - left) * f / Math.max(1, spec.frames - 1);
      const panel = (top, high, title, draw) => {
        ctx.fillStyle = colours.ink; ctx.textAlign = "left"; ctx.fillText(title, left, top + 11);
        ctx.fillStyle = colours.panel; ctx.fillRect(left, top + 18, right - left, high - 18);
        draw(top + 18, high - 18);
      };
      if (extremes) panel(0, 150, `a_y at sensor “${spec.trace.sensor}”, ± ${+spec.trace.peak_g.toPrecision(3)} g`, (top, high) => {
        ctx.strokeStyle = colours.blue; ctx.lineWidth = 1; ctx.beginPath();
        for (let f = 0; f < spec.frames; f++) {
          const y = (v) => top + high * (1 - extremes[2 * f + v] / 65535);
          // Joined to the frame before: where a frame is one sample, its extremes are one point.
          if (f) ctx.lineTo(x(f), y(0) + 0.5); else ctx.moveTo(x(f), y(0) + 0.5);
          ctx.lineTo(x(f), y(1) - 0.5);
        }
        ctx.stroke();
      });
      panel(160, 140, width < 440 ? `${element} ${spec.rollers[followed]}: outer, inner, to ${kilo(largest)}` : `${element} ${spec.rollers[followed]}: outer (blue) and inner raceway (orange), to ${kilo(largest)}`, (top, high) => {
        for (const [of, colour] of [[inner, colours.orange], [outer, colours.blue]]) {
          ctx.strokeStyle = colour; ctx.lineWidth = 1.5; ctx.beginPath();
          for (let f = 0; f < spec.frames; f++) ctx.lineTo(x(f), top + high * (1 - of[f * count + followed] / 255));
          ctx.stroke();
        }
      });
      ctx.strokeStyle = colours.red; ctx.lineWidth = 1.5;
      ctx.beginPath(); ctx.moveTo(x(at), 18); ctx.lineTo(x(at), 300); ctx.stroke();
      ctx.fillStyle = colours.faint; ctx.textAlign = "left"; ctx.fillText(`${ms(timeOf(0))} ms`, left, 316);
      ctx.textAlign = "right"; ctx.fillText(`${ms(timeOf(spec.frames - 1))} ms`, right, 316);
    };
    const ms = (s) => (1e3 * s).toFixed(spec.step_s < 1e-4 ? 2 : 1);

    const eventNow = () => {
      let now = null;
      for (const [t, what] of spec.events) if (Math.abs(t - timeOf(at)) < 0.06 * spec.passage_s) now = what;
      return now;
    };

    const show = (tell = true) => {
      drawBearing(); drawStrips();
      const words = `${ms(timeOf(at))} ms`, event = eventNow();
      scrubber.value = frame();
      scrubber.setAttribute("aria-valuetext", event ? `${words}, ${event}` : words);
      said.textContent = event ? `${words}: ${event}` : words;
      if (tell) document.dispatchEvent(new CustomEvent("bearing-time", { detail: timeOf(at) }));
    };

    const stop = () => { playing = false; play.textContent = "▶ Play"; };
    const tick = (now) => {
      if (!playing) return;
      const passed = last ? Math.min(0.1, (now - last) / 1000) : 0;
      last = now;
      at += passed / Number(slow.value) / spec.step_s;
      if (at >= spec.frames - 1) at = 0;
      show();
      requestAnimationFrame(tick);
    };
    const toggle = () => {
      if (playing) return stop();
      playing = true; last = 0; play.textContent = "❚❚ Stop";
      requestAnimationFrame(tick);
    };
    const go = (to) => { stop(); at = Math.min(spec.frames - 1, Math.max(0, to)); show(); };

    // A passage takes about three seconds; slower and quicker by steps.
    const usual = round(3 / (Number.isFinite(spec.passage_s) && spec.passage_s ? spec.passage_s : spec.frames * spec.step_s / 3));
    for (const times of [0.1, 0.2, 0.5, 1, 2, 5, 10]) {
      const factor = usual * times;
      if (factor < 1) continue;
      slow.add(new Option(`${+factor.toPrecision(3)} ×`, factor, times === 1, times === 1));
    }

    const paint = () => {
      for (const name of ["paper", "ink", "faint", "rule", "panel"]) colours[name] = theme("--" + name);
      for (const name of ["blue", "orange", "red", "grey"]) colours[name] = theme("--c-" + name);
      colours.steel = theme("--steel"); colours.line = theme("--c-grey"); colours.cage = theme("--cage"); colours.roller = theme("--paper");
      show(false);
    };
    play.addEventListener("click", toggle);
    scrubber.addEventListener("input", () => go(Number(scrubber.value)));
    figure.addEventListener("keydown", (e) => {
      if (e.target === slow) return;
      const steps = { ArrowLeft: -1, ArrowRight: 1, ArrowDown: -1, ArrowUp: 1 };
      if (e.key === " " && e.target !== play) toggle();
      else if (e.key in steps) go(frame() + steps[e.key] * (e.shiftKey ? 10 : 1));
      else if (e.key === "Home") go(0);
      else if (e.key === "End") go(spec.frames - 1);
      else return;
      e.preventDefault();
    });
    bearing.addEventListener("click", (e) => {
      const x = (e.offsetX - geometry.middle) / geometry.scale, y = (geometry.middle - e.offsetY) / geometry.scale;
      let nearest = Infinity;
      for (let n = 0; n < count; n++) {
        const a = angle(orbit, count, n);
        const off = Math.abs(Math.atan2(y, x) - a) % TAU, far = Math.min(off, TAU - off);
        if (far < nearest) { nearest = far; followed = n; }
      }
      show();
    });
    const scrub = (e) => {
      if (e.type === "pointermove" && !(e.buttons & 1)) return;
      go(Math.round((e.offsetX - 6) / (strips.clientWidth - 12) * (spec.frames - 1)));
    };
    strips.addEventListener("pointerdown", scrub);
    strips.addEventListener("pointermove", scrub);
    document.addEventListener("trace-time", (e) => {
      const to = (e.detail - spec.start_s) / spec.step_s - 0.5;
      if (to > -1 && to < spec.frames) go(to);
    });
    new ResizeObserver(() => show(false)).observe(figure);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", paint);
    matchMedia("print").addEventListener("change", paint);
    addEventListener("beforeprint", paint);
    paint();
    addEventListener("load", () => show());
  };

  document.querySelectorAll("figure.moving-bearing").forEach(setUp);
})();
