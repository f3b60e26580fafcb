// What the page hands over as files.

export function save(name, content, type) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([content], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

// Columns of a record, with their names and units in the first line.
export function csv(names, columns) {
  const lines = [names.join(",")];
  for (let i = 0; i < columns[0].length; i += 1) lines.push(columns.map((column) => column[i]).join(","));
  return `${lines.join("\n")}\n`;
}

// All canvases of the page on one, each under its heading.
export function poster(parts, heading, background, ink) {
  const wide = 1400, columns = 2, pad = 24, cell = (wide - pad * (columns + 1)) / columns;
  const placed = [], tops = [pad + 40, pad + 40];
  for (const { canvas, name } of parts.filter((part) => part.canvas.width > 0)) {
    const column = tops[0] <= tops[1] ? 0 : 1, high = cell * canvas.height / canvas.width;
    placed.push({ canvas, name, x: pad + column * (cell + pad), y: tops[column], high });
    tops[column] += high + 40;
  }
  const sheet = document.createElement("canvas");
  [sheet.width, sheet.height] = [wide, Math.max(...tops)];
  const c = sheet.getContext("2d");
  c.fillStyle = background;
  c.fillRect(0, 0, sheet.width, sheet.height);
  c.fillStyle = ink;
  c.font = "600 22px system-ui, sans-serif";
  c.fillText(heading, pad, pad + 16);
  c.font = "15px system-ui, sans-serif";
  for (const { canvas, name, x, y, high } of placed) { c.fillText(name, x, y + 12); c.drawImage(canvas, x, y + 20, cell, high); }
  return new Promise((done) => sheet.toBlob(done, "image/png"));
}

// The scene with the handles as they stand: fields that were turned, in its text as the program writes it.
export function sceneText(facts, scene, handles) {
  let text = facts.ron;
  const turned = (name) => handles[name] !== scene[name];
  const number = (value) => { const plain = Number(value.toPrecision(12)); return Number.isInteger(plain) ? `${plain}.0` : String(plain); };
  const part = (name) => new RegExp(`\n {4}${name}: (?:[^\n]*[(\\[]\n[\\s\\S]*?\n {4}[)\\]]+|[^\n]*),`);
  const whole = (name, value) => { text = text.replace(part(name), `\n    ${name}: ${value},`); };
  const read = (name, field) => (text.match(part(name)) || [""])[0].match(new RegExp(`\n {8}${field}: ([^\n]*),`));
  // A field that has its default may not be written: it is put first.
  const put = (name, field, value) => {
    text = text.replace(part(name), (block) => (read(name, field)
      ? block.replace(new RegExp(`(\n {8}${field}: )[^\n]*,`), `$1${value},`)
      : block.replace(/[(]\n/, `(\n        ${field}: ${value},\n`)));
  };
  if (turned("load")) put("operation", "load_n", number(handles.load));
  if (turned("direction")) put("operation", "load_angle_deg", number((((Math.atan2(facts.along[1], facts.along[0]) * 180 / Math.PI + handles.direction) % 360) + 360) % 360));
  if (turned("speed")) put("operation", "speed_rpm", number(handles.speed));
  if (turned("clearance")) put("bearing", "inner_race_diameter_mm", number(Number(read("bearing", "inner_race_diameter_mm")[1]) - 1e-3 * (handles.clearance - scene.clearance)));
  if (turned("friction")) put("contact", "friction", number(handles.friction));
  if (turned("contactDamping")) put("contact", "damping_ratio", number(handles.contactDamping));
  if (turned("massDamping")) put("solver", "mass_damping_per_s", number(handles.massDamping));
  if (turned("arcs")) put("contact", "surface", handles.arcs ? "arc" : "facet");
  if (turned("facets")) put("mesh", "roller_facets", String(handles.facets));
  if (turned("step")) put("model", "step_us", number(handles.step));
  if (turned("viscosity")) {
    if (!(handles.viscosity > 0)) whole("film", "None");
    else if (scene.viscosity > 0) put("film", "viscosity_pa_s", number(handles.viscosity));
    else whole("film", `(\n        viscosity_pa_s: ${number(handles.viscosity)},\n    )`);
  }
  if (!["spallRing", "spallAngle", "spallLength", "spallDepth", "spallSlope"].some(turned)) return text;
  const fields = { ring: handles.spallRing > 1 ? "inner" : "outer", length_mm: number(handles.spallLength), depth_mm: number(handles.spallDepth), angle_deg: number(handles.spallAngle), edge_slope_deg: number(handles.spallSlope) };
  const spall = handles.spallRing === 0 ? "None" : `(\n${Object.entries(fields).map(([name, value]) => `        ${name}: ${value},\n`).join("")}    )`;
  const more = !/\n {4}defects: \[\],/.test(text);
  whole("defect", spall);
  return more ? `// The spall of the lab is \`defect\`; those of \`defects\` stand as they stood.\n${text}` : text;
}
