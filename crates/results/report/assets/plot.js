// Turns every <figure class="plot"> into a chart: drag to zoom, wheel to zoom at the cursor, double click to reset.
(() => {
  "use strict";

  const floats = (text) => {
    const raw = atob(text);
    const bytes = new Uint8Array(raw.length);
    for (let i = 0; i < raw.length; i++) bytes[i] = raw.charCodeAt(i);
    return Array.from(new Float32Array(bytes.buffer), (v) => (Number.isNaN(v) ? null : v));
  };

  const PREFIXES = [[1e9, "G"], [1e6, "M"], [1e3, "k"], [1, ""], [1e-3, "m"], [1e-6, "µ"], [1e-9, "n"], [1e-12, "p"]];

  const prefixOf = (largest) => {
    const size = Math.abs(largest) * (1 + 1e-9);
    if (!size) return [1, ""];
    return PREFIXES.find(([factor]) => size >= factor) || PREFIXES[PREFIXES.length - 1];
  };

  const minus = (text) => (/^-0(\.0*)?$/.test(text) ? text.slice(1) : text.replace("-", "−"));

  const places = (step) => Math.min(9, Math.max(0, Math.ceil(-Math.log10(step) - 1e-9)));

  // All ticks of an axis share one prefix; neighbours differ in their last decimal.
  const tickTexts = (axis) => (u, splits, i, space, step) => {
    if (axis.names.length) return splits.map((v) => axis.names[v - 1] ?? "");
    const largest = splits.reduce((m, v) => Math.max(m, Math.abs(v)), 0);
    const [factor, prefix] = axis.ticks === "prefixed" ? prefixOf(largest) : [1, ""];
    const unit = axis.ticks === "prefixed" && axis.unit ? " " + prefix + axis.unit : "";
    if (axis.ticks === "decades") return splits.map((v) => String(Number(Math.pow(10, v).toPrecision(2))));
    return splits.map((v) => minus((v / factor).toFixed(places(step / factor))) + unit);
  };

  // Cursor readout: six digits tell neighbouring samples apart.
  const readout = (axis, digits) => (u, v) => {
    if (v == null) return "–";
    const [factor, prefix] = axis.ticks === "prefixed" ? prefixOf(v) : [1, ""];
    if (axis.ticks === "decades") v = Math.pow(10, v);
    return minus(String(Number((v / factor).toPrecision(digits)))) + " " + prefix + axis.unit;
  };

  const tables = (spec) => {
    const one = spec.series.map((s) => {
      const y = floats(s.y);
      const x = s.uniform ? y.map((_, n) => s.uniform[0] + s.uniform[1] * n) : floats(s.x).map((v) => s.origin + v);
      return [x, y];
    });
    const shared = (a, b) => a.length === b.length && a[0] === b[0] && a[a.length - 1] === b[b.length - 1];
    if (one.length && one.every(([x]) => shared(x, one[0][0]))) return [one[0][0], ...one.map(([, y]) => y)];
    // Joining leaves undefined where only another curve has a point; uPlot draws across that, and breaks at null.
    return one.length ? uPlot.join(one) : [[], []];
  };

  // Shaded grounds have two edges, one after the other.
  const pairsOf = (list) => list.flatMap((first, i) => (i % 2 ? [] : [[first, list[i + 1]]]));

  const theme = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

  // Lowest free row for each label, from left to right.
  const rowsOf = (boxes) => {
    const ends = [];
    return boxes.map(([centre, width]) => {
      let row = ends.findIndex((end) => end <= centre - width / 2);
      if (row < 0) row = ends.length;
      ends[row] = centre + width / 2;
      return row;
    });
  };

  // Steps of 1, 2 and 5 only: their multiples never need more decimals than the step itself.
  const STEPS = [];
  for (let power = -15; power <= 15; power++) for (const m of [1, 2, 5]) STEPS.push(Number(`${m}e${power}`));

  // Powers of ten and as many numbers between them as make three ticks; nearer than that, equal steps.
  const decades = (u, i, low, high, step) => {
    const between = high - low > 4 ? [[1]] : [[1, 2, 5], [1, 1.5, 2, 3, 4, 5, 6, 7, 8, 9]];
    const ticks = between.map((digits) => {
      const all = [];
      for (let power = Math.floor(low); power <= high; power++) for (const m of digits) all.push(power + Math.log10(m));
      return all.filter((at) => at >= low && at <= high);
    });
    const enough = ticks.find((all) => all.length > 2);
    if (enough) return enough;
    const all = [];
    for (let n = Math.ceil(low / step); n * step <= high; n++) all.push(n * step);
    return all;
  };

  const FONT = "12px system-ui, sans-serif";
  const ROW = 15;
  const ruler = document.createElement("canvas").getContext("2d");
  ruler.font = FONT;
  const widthOf = (label) => ruler.measureText(label).width + 10;

  const visibleMarks = (marks, from, to) => marks.filter((m) => m.x >= from && m.x <= to).sort((a, b) => a.x - b.x);

  const decorate = (spec, rowLimit) => ({
    hooks: {
      drawClear: (u) => {
        const { ctx, bbox } = u;
        ctx.save();
        ctx.beginPath();
        ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
        ctx.clip();
        ctx.fillStyle = theme("--shade");
        for (const [from, to] of spec.bands) {
          const a = u.valToPos(from, "x", true), b = u.valToPos(to, "x", true);
          ctx.fillRect(a, bbox.top, b - a, bbox.height);
        }
        ctx.restore();
      },
      draw: (u) => {
        const { ctx, bbox } = u, ratio = devicePixelRatio;
        const seen = visibleMarks(spec.marks, u.scales.x.min, u.scales.x.max);
        const at = seen.map((m) => u.valToPos(m.x, "x", true));
        const rows = rowsOf(seen.map((m, i) => [at[i], widthOf(m.label) * ratio]));
        ctx.save();
        ctx.font = FONT.replace("12", String(12 * ratio));
        ctx.textAlign = "center";
        ctx.textBaseline = "alphabetic";
        ctx.lineWidth = ratio;
        const tops = rows.map((row) => bbox.top - (8 + ROW * Math.min(row, rowLimit)) * ratio);
        ctx.globalAlpha = 0.85;
        seen.forEach((m, i) => {
          ctx.strokeStyle = theme(m.colour);
          ctx.setLineDash(m.dashed ? [5 * ratio, 4 * ratio] : []);
          ctx.beginPath();
          ctx.moveTo(at[i], tops[i]);
          ctx.lineTo(at[i], bbox.top + bbox.height);
          ctx.stroke();
        });
        ctx.globalAlpha = 1;
        ctx.setLineDash([5 * ratio, 4 * ratio]);
        for (const level of spec.levels) {
          if (level.y < u.scales.y.min || level.y > u.scales.y.max) continue;
          const up = u.valToPos(level.y, "y", true), right = bbox.left + bbox.width;
          ctx.strokeStyle = theme(level.colour);
          ctx.beginPath();
          ctx.moveTo(bbox.left, up);
          ctx.lineTo(right, up);
          ctx.stroke();
        }
        ctx.setLineDash([]);
        // Labels come after all lines, on ground of their own, so that no line crosses a word.
        seen.forEach((m, i) => {
          if (!m.label || rows[i] > rowLimit) return;
          const half = widthOf(m.label) * ratio / 2;
          const inside = Math.min(Math.max(at[i], half), ctx.canvas.width - half);
          ctx.fillStyle = theme("--paper");
          ctx.fillRect(inside - half + 3 * ratio, tops[i] - 13 * ratio, 2 * half - 6 * ratio, 14 * ratio);
          ctx.fillStyle = theme(m.colour);
          ctx.fillText(m.label, inside, tops[i] - 2 * ratio);
        });
        ctx.restore();
      },
    },
  });

  // Charts of one key zoom together: dragging does so in uPlot itself, the wheel here.
  const linked = new Map();

  const wheelZoom = (place, key) => ({
    hooks: {
      ready: (u) => {
        const [low, high] = [u.scales.x.min, u.scales.x.max];
        const group = key ? linked.get(key) || linked.set(key, []).get(key) : [];
        group.push(u);
        u.over.addEventListener("wheel", (e) => {
          // A plain wheel scrolls the page until the chart has been clicked.
          if (!(e.ctrlKey || e.metaKey || e.shiftKey || place.contains(document.activeElement))) return;
          e.preventDefault();
          const delta = e.deltaY || e.deltaX;
          const factor = delta < 0 ? 0.75 : 1 / 0.75;
          const { min, max } = u.scales.x;
          const at = u.posToVal(e.offsetX, "x");
          const from = Math.max(low, at - (at - min) * factor), to = Math.min(high, at + (max - at) * factor);
          if (to - from > (high - low) * 1e-6) group.forEach((other) => other.setScale("x", { min: from, max: to }));
        }, { passive: false });
      },
    },
  });

  // The moving bearing shows its time on every chart over the time of the run, and a click there moves it.
  const playhead = {
    hooks: {
      ready: (u) => {
        u.playhead = u.over.appendChild(document.createElement("div"));
        u.playhead.className = "playhead";
        let from = 0;
        u.over.addEventListener("pointerdown", (e) => { from = e.clientX; });
        u.over.addEventListener("click", (e) => {
          if (Math.abs(e.clientX - from) > 3) return;
          const at = u.posToVal(e.clientX - u.over.getBoundingClientRect().left, "x");
          document.dispatchEvent(new CustomEvent("trace-time", { detail: at }));
        });
        document.addEventListener("bearing-time", (e) => { u.time = e.detail; place(u); });
      },
      draw: (u) => place(u),
    },
  };
  const place = (u) => {
    if (!u.playhead) return;
    const shown = u.time != null && u.time >= u.scales.x.min && u.time <= u.scales.x.max;
    u.playhead.style.display = shown ? "block" : "none";
    if (shown) u.playhead.style.transform = `translateX(${u.valToPos(u.time, "x")}px)`;
  };

  const axisStyle = (axis, size) => ({
    label: axis.ticks === "prefixed" || !axis.unit ? axis.label : `${axis.label} [${axis.unit}]`,
    labelFont: "13px system-ui, sans-serif",
    font: FONT,
    labelSize: 22,
    size,
    stroke: () => theme("--ink"),
    grid: { stroke: () => theme("--grid"), width: 1 },
    ticks: { stroke: () => theme("--grid"), width: 1, size: 5 },
    values: tickTexts(axis),
    splits: axis.ticks === "decades" ? decades : undefined,
    incrs: axis.ticks === "angle" ? [1, 5, 10, 15, 30, 45, 90] : axis.ticks === "counted" ? STEPS.filter((step) => step >= 1) : STEPS,
  });

  const build = (figure) => {
    const holder = figure.querySelector(".chart");
    const spec = JSON.parse(figure.querySelector('script[type="application/json"]').textContent);
    const data = tables(spec);
    const width = () => Math.max(320, holder.clientWidth);
    const [from, to] = spec.x.range || [data[0][0] ?? 0, data[0][data[0].length - 1] ?? 1];
    const pixels = (x) => ((x - from) / (to - from)) * (width() - 100);
    const first = visibleMarks(spec.marks, from, to).map((m) => [pixels(m.x), widthOf(m.label)]);
    const rowLimit = Math.min(5, Math.max(-1, ...rowsOf(first)));
    const held = spec.levels.map((level) => level.y);
    const cursors = spec.cursor && spectrumCursors(figure, spec, { theme, prefixOf, data });
    const fixed = (range) => {
      if (range) return { range: () => range };
      if (!held.length) return {};
      return { range: (u, low, high) => uPlot.rangeNum(Math.min(low, ...held), Math.max(high, ...held), 0.1, true) };
    };
    const chart = new uPlot({
      width: width(),
      height: 330 + ROW * (rowLimit + 1),
      padding: [14 + ROW * (rowLimit + 1), 22, 0, 4],
      cursor: { drag: { x: true, y: false }, focus: { prox: 24 }, sync: spec.sync ? { key: spec.sync } : undefined },
      legend: { live: true },
      hooks: { setCursor: [(u) => figure.classList.toggle("read", u.cursor.left >= 0)] },
      scales: { x: { time: false, ...(spec.x.range ? { range: (u, a, b) => (a == null ? spec.x.range : [a, b]) } : {}) }, y: fixed(spec.y.range) },
      // On a phone ticks stand nearer together, so that an axis has more than two.
      axes: [{ ...axisStyle(spec.x, 34), space: (u, i, low, high, length) => Math.max(44, Math.min(80, length / 6)) }, { ...axisStyle(spec.y, 74), space: 36 }],
      series: [
        { label: spec.x.label, value: readout(spec.x, 6) },
        ...spec.series.map((s) => ({
          label: s.name,
          stroke: () => theme(s.colour),
          width: s.edge ? 0 : 1.2,
          paths: s.points ? () => null : undefined,
          points: s.points ? { show: true, size: 6, fill: () => theme(s.colour) } : { show: false },
          value: readout(spec.y, 4),
        })),
      ],
      bands: pairsOf(spec.series.flatMap((s, i) => (s.edge ? [i + 1] : []))).map((pair) => (
        { series: pair, fill: () => theme(spec.series[pair[0] - 1].colour) + "40" })),
      plugins: [decorate(spec, rowLimit), wheelZoom(holder, spec.sync), ...(spec.run_time ? [playhead] : []), ...(cursors ? [cursors.plugin] : [])],
    }, data, holder);
    if (spec.x.range) chart.setScale("x", { min: from, max: to });
    // uPlot resets to the data; a figure with a fixed range resets to that.
    if (spec.x.range) chart.over.addEventListener("dblclick", () => chart.setScale("x", { min: from, max: to }));
    holder.addEventListener("pointerdown", () => holder.focus({ preventScroll: true }));
    new ResizeObserver(() => chart.setSize({ width: width(), height: chart.height })).observe(holder);
    if (spec.wide) {
      const words = ([a, b]) => `${tickTexts(spec.x)(chart, [a], 0, 0, b).toString().replace(/ .*/, "")} to ${tickTexts(spec.x)(chart, [b], 0, 0, b)}`;
      const button = document.createElement("button");
      let wide = false;
      const label = () => { button.textContent = wide ? `Only ${words([from, to])}` : `Whole band, ${words(spec.wide)}`; };
      button.type = "button";
      button.className = "wide";
      button.addEventListener("click", () => {
        wide = !wide;
        const [min, max] = wide ? spec.wide : [from, to];
        chart.setScale("x", { min, max });
        label();
      });
      label();
      holder.after(button);
    }
    if (cursors) cursors.attach(chart, holder);
    figure.classList.add("live");
    return chart;
  };

  // Figures of a group: one is seen, the others keep their width so that their charts do.
  const tabs = (group) => {
    const buttons = [...group.querySelectorAll('[role="tab"]')], panels = [...group.querySelectorAll(".panel")];
    const choose = (chosen) => {
      buttons.forEach((button, n) => {
        button.setAttribute("aria-selected", n === chosen);
        button.tabIndex = n === chosen ? 0 : -1;
      });
      panels.forEach((panel, n) => panel.classList.toggle("on", n === chosen));
    };
    buttons.forEach((button, n) => {
      button.addEventListener("click", () => choose(n));
      button.addEventListener("keydown", (e) => {
        const step = { ArrowRight: 1, ArrowLeft: buttons.length - 1 }[e.key];
        if (!step) return;
        const next = (n + step) % buttons.length;
        choose(next);
        buttons[next].focus();
      });
    });
    group.chooseOf = (element) => choose(panels.findIndex((panel) => panel.contains(element)));
    group.classList.add("live");
    choose(0);
  };

  // A link to what is folded up, or behind a tab, opens it.
  const follow = () => {
    const wanted = location.hash.length > 1 && document.getElementById(decodeURIComponent(location.hash.slice(1)));
    if (!wanted) return;
    for (let fold = wanted.closest("details"); fold; fold = fold.parentElement.closest("details")) fold.open = true;
    const group = wanted.closest(".tabs");
    if (group) group.chooseOf(wanted);
    wanted.scrollIntoView();
  };

  const save = (name, address) => {
    const link = document.createElement("a");
    link.download = name;
    link.href = address;
    link.click();
  };

  // Each figure as a file: its drawing as it is, and the same in pixels, twice as fine as on the page.
  const saving = (figure) => {
    const svg = figure.querySelector(".still svg, .drawing svg");
    const image = figure.querySelector(".drawing img"), canvas = figure.querySelector("canvas.bearing");
    const text = () => new XMLSerializer().serializeToString(svg);
    const address = () => "data:image/svg+xml;charset=utf-8," + encodeURIComponent(text());
    const forms = [];
    if (svg) {
      forms.push(["SVG", () => save(figure.id + ".svg", address())]);
      forms.push(["PNG", () => {
        const picture = new Image();
        picture.onload = () => {
          const paper = document.createElement("canvas");
          paper.width = 2 * svg.width.baseVal.value;
          paper.height = 2 * svg.height.baseVal.value;
          paper.getContext("2d").drawImage(picture, 0, 0, paper.width, paper.height);
          save(figure.id + ".png", paper.toDataURL("image/png"));
        };
        picture.src = address();
      }]);
    } else if (image) {
      const form = image.src.slice(11, 14).toUpperCase();
      forms.push([form, () => save(`${figure.id}.${form.toLowerCase()}`, image.src)]);
    } else if (canvas) {
      forms.push(["PNG", () => save(figure.id + ".png", canvas.toDataURL("image/png"))]);
    }
    if (!forms.length) return;
    const row = document.createElement("div");
    row.className = "save";
    for (const [form, go] of forms) {
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = form;
      button.title = "Save this figure as " + form;
      button.addEventListener("click", go);
      row.append(button);
    }
    figure.prepend(row);
  };

  addEventListener("DOMContentLoaded", () => {
    document.querySelectorAll(".tabs").forEach(tabs);
    document.querySelectorAll("figure").forEach(saving);
    addEventListener("hashchange", follow);
    follow();
    // Charts that are folded up have no width yet: they are built when they are first seen.
    const charts = [];
    const buildSeen = () => document.querySelectorAll("figure.plot:not(.live)").forEach((figure) => {
      if (!figure.closest("details:not([open])")) charts.push(build(figure));
    });
    buildSeen();
    document.querySelectorAll("details").forEach((fold) => fold.addEventListener("toggle", buildSeen));
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => charts.forEach((c) => c.redraw()));
  });
})();
