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

// The scene with the handles as they stand: fields that were turned, in the text of the scene.
export function sceneText(ron, scene, handles) {
  let text = ron;
  const turned = (name) => handles[name] !== scene[name];
  const number = (value) => (Number.isInteger(value) ? `${value}.0` : String(value));
  const put = (field, value) => { text = text.replace(new RegExp(`(\\b${field}: )[^,\\n]*,`), `$1${value},`); };
  if (turned("load")) put("load_n", number(handles.load));
  if (turned("speed")) put("speed_rpm", number(handles.speed));
  if (turned("friction")) put("friction", number(handles.friction));
  if (turned("contactDamping")) put("damping_ratio", number(handles.contactDamping));
  if (turned("massDamping")) put("mass_damping_per_s", number(handles.massDamping));
  if (turned("arcs")) put("surface", handles.arcs ? "arc" : "facet");
  if (turned("facets")) put("roller_facets", String(handles.facets));
  if (turned("viscosity") && handles.viscosity > 0) put("viscosity_pa_s", number(handles.viscosity));
  const spall = ["spallRing", "spallAngle", "spallLength", "spallDepth", "spallSlope"];
  if (spall.some(turned)) {
    const block = handles.spallRing === 0 ? "None" : `(\n        ring: ${handles.spallRing > 1 ? "inner" : "outer"},\n        length_mm: ${number(handles.spallLength)},\n        depth_mm: ${number(handles.spallDepth)},\n        angle_deg: ${number(handles.spallAngle)},\n        edge_slope_deg: ${number(handles.spallSlope)},\n    )`;
    text = text.replace(/(\n {4}defect: )(None|(Some\()?\([\s\S]*?\n {4}\)+),/, `$1${block},`);
  }
  const left = ["clearance", "direction"].filter(turned).map((name) => `// ${name} was turned to ${handles[name]} in the lab: see the fields of \`bearing\` and \`operation\`.\n`);
  if (turned("viscosity") && !(handles.viscosity > 0)) left.push("// The oil was taken away in the lab: `film: None`.\n");
  return left.join("") + text;
}
