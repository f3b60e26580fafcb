// Harmonic and sideband cursors of spectra: lines at multiples of a frequency, or about one at equal distances.
window.spectrumCursors = (figure, spec, { theme, prefixOf, data }) => {
  const MOST = 40;
  const unit = spec.x.unit;
  let chart = null, mode = "off", base = null, carrier = null;

  const element = (name, inside, attributes = {}) => {
    const made = document.createElement(name);
    Object.assign(made, attributes);
    inside.append(made);
    return made;
  };
  const box = document.createElement("div");
  box.className = "cursors";
  element("span", box, { textContent: "Cursor:" });
  const buttons = {};
  for (const [name, words, title] of [
    ["harmonics", "harmonics", "Lines at multiples of a frequency. Click a line of the spectrum to take it"],
    ["sidebands", "sidebands", "Lines about a carrier. Click a line to take it as carrier, with Shift as sideband"],
  ]) {
    buttons[name] = element("button", box, { type: "button", textContent: words, title });
    buttons[name].setAttribute("aria-pressed", "false");
    buttons[name].addEventListener("click", () => choose(mode === name ? "off" : name));
  }
  const field = (words) => {
    const label = element("label", box, { textContent: words + " ", hidden: true });
    const input = element("input", label, { type: "number", step: "any", min: "0" });
    label.append(" " + unit);
    return [label, input];
  };
  const [carrierLabel, carrierInput] = field("carrier");
  const [baseLabel, baseInput] = field("fundamental");
  const baseWords = baseLabel.firstChild;
  const known = element("select", box, { hidden: true, title: "Take a known frequency" });
  known.add(new Option("known …", ""));
  for (const [name, hz] of spec.cursor.known) known.add(new Option(`${name} ${+hz.toPrecision(5)} ${unit}`, hz));
  const said = element("output", box, { hidden: true });

  // Level of the first foreground curve at the highest point within reach of x, and where that is.
  const curve = () => {
    const n = spec.series.findIndex((s) => s.colour !== "--c-grey");
    return [data[0], data[(n < 0 ? 0 : n) + 1] || []];
  };
  const peak = (x, reach) => {
    const [xs, ys] = curve();
    let low = 0, high = xs.length;
    while (low < high) { const middle = (low + high) >> 1; if (xs[middle] < x - reach) low = middle + 1; else high = middle; }
    let best = null;
    for (let n = low; n < xs.length && xs[n] <= x + reach; n++) if (ys[n] != null && (best === null || ys[n] > best[1])) best = [xs[n], ys[n]];
    return best;
  };
  const inView = () => [chart.scales.x.min, chart.scales.x.max];
  const grid = () => { const [xs] = curve(); return xs.length > 1 ? (xs[xs.length - 1] - xs[0]) / (xs.length - 1) : 1; };
  const pixel = () => { const [min, max] = inView(); return (max - min) / Math.max(1, chart.bbox.width / devicePixelRatio); };

  const lines = () => {
    const [min, max] = inView(), made = [];
    if (mode === "harmonics" && base > 0) {
      for (let n = Math.max(1, Math.ceil(min / base)); n * base <= max && made.length < MOST; n++) made.push([n * base, `${n}×`]);
    } else if (mode === "sidebands" && base > 0 && carrier > 0) {
      for (let n = -MOST / 2; n <= MOST / 2; n++) {
        const x = carrier + n * base;
        if (x >= min && x <= max) made.push([x, n === 0 ? "carrier" : (n > 0 ? "+" : "−") + Math.abs(n)]);
      }
    }
    return made;
  };

  const number = (x, digits) => String(+x.toPrecision(digits)).replace("-", "−");
  const update = () => {
    for (const name in buttons) buttons[name].setAttribute("aria-pressed", mode === name);
    const on = mode !== "off";
    for (const part of [baseLabel, known, said]) part.hidden = !on;
    carrierLabel.hidden = mode !== "sidebands";
    baseWords.textContent = mode === "sidebands" ? "spacing " : "fundamental ";
    if (document.activeElement !== baseInput) baseInput.value = base ? number(base, 7) : "";
    if (document.activeElement !== carrierInput) carrierInput.value = carrier ? number(carrier, 7) : "";
    if (on) {
      const reach = Math.max(1.5 * grid(), 0.5 * pixel());
      said.textContent = lines().slice(0, 12).map(([x, words]) => {
        const at = peak(x, reach);
        const [factor, prefix] = spec.x.ticks === "prefixed" ? prefixOf(x) : [1, ""];
        return `${words} ${number(x / factor, 5)} ${prefix}${unit}${at ? ` (${number(at[1], 3)})` : ""}`;
      }).join(" · ") || "nothing in view";
    }
    if (chart) chart.redraw(false, false);
  };

  const choose = (wanted) => {
    mode = wanted;
    const [min, max] = inView(), middle = peak(0.5 * (min + max), 0.5 * (max - min) - 2 * grid());
    const inside = spec.cursor.known.map(([, hz]) => hz).filter((hz) => hz > 0 && hz < max - min);
    if (mode === "harmonics" && !(base > 0)) base = inside[0] || (middle ? middle[0] : 0.5 * (min + max));
    if (mode === "sidebands") {
      if (!(base > 0)) base = inside[0] || 0.05 * (max - min);
      if (!(carrier > 0)) carrier = middle ? middle[0] : 0.5 * (min + max);
    }
    update();
  };

  const take = (x, shifted) => {
    const found = peak(x, 6 * pixel()), at = found ? found[0] : x;
    if (mode === "harmonics") {
      // With Shift the line clicked is a multiple of the fundamental, which it makes sharper.
      base = shifted && base > 0 ? at / Math.max(1, Math.round(at / base)) : at;
    } else if (shifted) {
      const off = Math.abs(at - carrier);
      base = off / Math.max(1, base > 0 ? Math.round(off / base) : 1) || base;
    } else {
      carrier = at;
    }
    update();
  };

  baseInput.addEventListener("input", () => { base = Number(baseInput.value); update(); });
  carrierInput.addEventListener("input", () => { carrier = Number(carrierInput.value); update(); });
  known.addEventListener("change", () => { if (known.value) base = Number(known.value); known.value = ""; update(); });

  const draw = (u) => {
    const all = lines();
    if (!all.length) return;
    const { ctx, bbox } = u, ratio = devicePixelRatio;
    ctx.save();
    ctx.strokeStyle = ctx.fillStyle = theme("--c-pink");
    ctx.lineWidth = 1.2 * ratio;
    ctx.font = `${11 * ratio}px system-ui, sans-serif`;
    ctx.textAlign = "left";
    let last = -Infinity;
    for (const [x, words] of all) {
      const at = u.valToPos(x, "x", true);
      ctx.setLineDash(words === "carrier" || words === "1×" ? [] : [2 * ratio, 3 * ratio]);
      ctx.beginPath(); ctx.moveTo(at, bbox.top); ctx.lineTo(at, bbox.top + bbox.height); ctx.stroke();
      if (at - last > 34 * ratio) { ctx.fillText(words, at + 3 * ratio, bbox.top + 12 * ratio); last = at; }
    }
    ctx.restore();
  };

  return {
    plugin: { hooks: { draw, setScale: () => { if (chart && mode !== "off") requestAnimationFrame(update); } } },
    attach: (made, holder) => {
      chart = made;
      holder.after(box);
      let from = 0;
      chart.over.addEventListener("pointerdown", (e) => { from = e.clientX; });
      chart.over.addEventListener("click", (e) => {
        if (mode === "off" || Math.abs(e.clientX - from) > 3) return;
        take(chart.posToVal(e.clientX - chart.over.getBoundingClientRect().left, "x"), e.shiftKey);
      });
      holder.addEventListener("keydown", (e) => {
        const step = { ArrowLeft: -1, ArrowRight: 1 }[e.key];
        if (mode === "off" || !step || !(base > 0)) return;
        // A tenth of a line of the grid moves the tenth harmonic by one.
        base = Math.max(grid() * 0.1, base + step * (e.shiftKey ? 1 : 0.1) * grid());
        update();
        e.preventDefault();
      });
    },
  };
};
