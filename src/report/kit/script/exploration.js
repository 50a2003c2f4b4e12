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

/** Hears of presses on a plot's points. */
function onPick(plot, act) {
  plot.over.addEventListener("click", () => {
    const { trace, point } = nearestPoint(plot);
    if (trace !== null) act(trace - 1, point);
  });
}

function drawExploration(place, points) {
  const tagOf = { best: new Set(points.best), faint: new Set(points.faint) };
  const group = row => (tagOf.best.has(row) ? "best" : tagOf.faint.has(row) ? "faint" : "plain");
  const columns = [
    ...points.keys.map(key => ({ name: key.name, short: key.name.split(".").pop(), label: key.label, values: shownValues(key) })),
    ...points.measures.map(m => ({ name: m.name, short: m.name, label: m.label, values: m.values })),
  ];
  const picked = pickedPoint(points);
  const isMap = points.is_grid && points.keys.length === 2;
  const plots = element("div");
  place.append(picked.host, plots);
  // A grid over one key is drawn above, as a line.
  const scatters = points.is_grid && points.keys.length === 1 ? { keep() {} } : makeScatters(plots, points, columns, group, picked.pick);
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
  const refresh = () => scatters.keep(row => isBrushed(row) && table.isKept(row));
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

/** Plots of every measure over one key, which the reader chooses. */
function makeScatters(host, points, columns, group, pick) {
  const keys = columns.slice(0, points.keys.length);
  const measures = columns.slice(points.keys.length);
  const grid = element("div", { class: "grid" });
  const groups = [["faint", "silver", "does not count"], ["plain", "blue", "point"], ["best", "vermilion", "best"]];
  const rowsOf = groups.map(([name]) => points.index.map((_, row) => row).filter(row => group(row) === name));
  let plots = [];
  let isKept = () => true;
  const dataOf = (key, measure) => rowsOf.map(rows => {
    const kept = rows.filter(isKept);
    return [kept.map(row => key.values[row]), kept.map(row => measure.values[row])];
  });
  const show = key => {
    plots.forEach(({ plot }) => { drawn.delete(plot); plot.destroy(); });
    grid.replaceChildren();
    plots = measures.map(measure => {
      const own = element("figure", {}, element("figcaption"));
      grid.append(own);
      const figure = { x_label: key.label, y_label: measure.label, marks: [], title: measure.name, file: `${measure.name}_over_${key.short}.csv` };
      const around = frame(own, figure, () => csvOf([[key.name, measure.name], ...points.index.map((_, row) => [key.values[row], measure.values[row]])]));
      const traces = dataOf(key, measure).map(([x, y], i) => ({ x, y, colour: groups[i][1], label: groups[i][2], style: "points" }));
      const plot = scatterInto(around.plot(figure.y_label), 240, figure, traces, (trace, i) => around.read(trace === null ? "" :
        [reading(key.label, trace.x[i]), reading(measure.label, trace.y[i])].join(" · ")));
      traces.forEach((t, i) => rowsOf[i].length > 0 && rowsOf.filter(r => r.length).length > 1 &&
        around.key(t.label, t.colour, "dot", isShown => plot.setSeries(i + 1, { show: isShown })));
      onPick(plot, (trace, i) => pick(rowsOf[trace].filter(isKept)[i]));
      around.onWhole(() => plot.setData(plot.data));
      return { plot, traces, renew: () => {
        const data = dataOf(key, measure);
        traces.forEach((t, i) => { [t.x, t.y] = data[i]; });
        plot.setData([null, ...data], false);
        plot.redraw();
      } };
    });
  };
  const buttons = keys.map((key, i) => {
    const button = element("button", { "aria-pressed": String(i === 0), "data-key": key.name }, key.name);
    button.addEventListener("click", () => {
      buttons.forEach(b => b.setAttribute("aria-pressed", String(b === button)));
      show(key);
    });
    return button;
  });
  if (keys.length > 1) host.append(element("div", { class: "choices" }, element("span", {}, "over"), ...buttons));
  host.append(grid);
  show(keys[0]);
  return { keep: kept => { isKept = kept; plots.forEach(({ renew }) => renew()); } };
}
