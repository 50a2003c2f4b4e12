// The points of a sweep: plots of each measure over a key, maps, parallel coordinates, a table, and each point's command.

const shownValues = key => key.values.map(value => value / key.factor);

/** A word of a command line as a shell takes it. */
const quoted = word => (/^[\w@%+=:,./-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`);
/** A number as a scene takes it for one that need not be whole. */
const literal = value => (Number.isInteger(value) && Math.abs(value) < 1e21 ? value.toFixed(1) : String(value));

function commandOf(points, row) {
  const sets = points.keys.flatMap(key => key.sets.flatMap(name => ["--set", `${name}=${literal(key.values[row])}`]));
  return [...points.command, ...sets].map(quoted).join(" ");
}

/** A place that shows a point and its command. */
function pickedPoint(points) {
  const words = element("p", { class: "small" }, "Press a point, or a row of the table, for the command that runs it.");
  const command = element("code", { class: "command", hidden: "" });
  const copy = element("button", { hidden: "" }, "copy");
  copy.addEventListener("click", async () => {
    try {
      await navigator.clipboard.writeText(command.textContent);
      copy.textContent = "copied";
    } catch {
      // Without leave to write the clipboard, the text is marked for the reader's own keys.
      getSelection().selectAllChildren(command);
      copy.textContent = "marked";
    }
    setTimeout(() => { copy.textContent = "copy"; }, 1500);
  });
  const host = element("div", { class: "picked" }, words, element("div", { class: "tools" }, command, copy));
  const pick = row => {
    const values = [...points.keys.map(k => reading(k.label, k.values[row] / k.factor)),
      ...points.measures.map(m => reading(m.label, m.values[row]))];
    words.textContent = `Point ${points.index[row]}: ${values.join(" · ")}`;
    command.textContent = commandOf(points, row);
    copy.hidden = command.hidden = false;
  };
  return { host, pick };
}

function drawExploration(place, points) {
  const tagOf = { best: new Set(points.best), faint: new Set(points.faint) };
  const group = row => (tagOf.best.has(row) ? "best" : tagOf.faint.has(row) ? "faint" : "plain");
  const columns = [
    ...points.keys.map(key => ({ name: key.name, short: key.label.split(".").pop(), label: key.label, marks: key.marks, values: shownValues(key) })),
    ...points.measures.map(m => ({ name: m.name, short: m.name, label: m.label, values: m.values })),
  ];
  const picked = pickedPoint(points);
  const isMap = points.is_grid && points.keys.length === 2;
  place.append(picked.host);
  const plots = makePointPlots(place, points, columns, group, picked.pick);
  if (isMap) {
    const maps = element("div", { class: "grid" });
    place.append(element("h3", {}, "Maps"), maps);
    points.measures.forEach(measure => {
      const own = element("figure", {}, element("figcaption"));
      maps.append(own);
      drawMap(own, points, measure, picked.pick);
    });
  }
  const host = element("div");
  const clear = element("button", {}, "all points again");
  place.append(element("h3", {}, "Parallel coordinates"),
    element("p", { class: "small" }, "Draw a stretch on an axis to keep the points that pass through it; press the axis to take it away."),
    element("div", { class: "tools" }, clear), host, element("h3", {}, "Table"),
    element("p", { class: "tools" }, download(points.file, tableCsv(points), points.whole)));
  let isBrushed = () => true;
  const refresh = () => plots.keep(row => isBrushed(row) && table.isKept(row));
  const names = { best: "vermilion", faint: "silver", plain: "blue" };
  const order = rows => ["faint", "plain", "best"].flatMap(g => rows.filter(row => group(row) === g).map(row => ({ row, name: names[g] })));
  const parallel = drawParallel(host, columns, order, kept => {
    isBrushed = kept;
    table.brush(kept);
    refresh();
  });
  clear.addEventListener("click", parallel.clear);
  repainted.add(parallel.paint);
  const tag = row => (tagOf.best.has(row) ? " ★" : "");
  const table = drawPointTable(place, columns, { index: points.index, tag, pick: picked.pick, onFilter: () => refresh() });
}

const tableCsv = points => () => csvOf([
  ["index", ...points.keys.map(k => k.name), ...points.measures.map(m => m.name)],
  ...points.index.map((index, row) => [index, ...points.keys.map(k => k.values[row]), ...points.measures.map(m => m.values[row])]),
]);
