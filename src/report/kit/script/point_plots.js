// Plots of a sweep's points: the objectives against each other, and each measure over a key that the reader chooses.

/** Kinds of points, drawn in this order: name, colour, label. */
const GROUPS = [["faint", "silver", "does not count"], ["plain", "blue", "point"], ["best", "vermilion", "best"]];

/** Hears of presses on a plot's points. */
function onPick(plot, act, reach) {
  plot.over.addEventListener("click", () => {
    const { trace, point } = nearestPoint(plot, reach);
    if (trace !== null) act(trace - 1, point);
  });
}

/** One plot of two columns; `state.isKept(row)` says which points it shows, `renew()` that it is to ask again. */
function pointPlot(host, [x, y], { rowsOf, state, pick, index, height }) {
  const own = element("figure", {}, element("figcaption"));
  host.append(own);
  const marks = (x.marks ?? []).map(([label, at]) => ({ label, at, colour: "grey" }));
  const figure = { x_label: x.label, y_label: y.label, marks, title: `${y.name} over ${x.name}`, file: `${y.name}_over_${x.name.split(".").pop()}.csv` };
  const around = frame(own, figure, () => csvOf([[x.name, y.name], ...index.map((_, row) => [x.values[row], y.values[row]])]));
  const keptOf = rows => rows.filter(row => state.isKept(row));
  const dataOf = rows => [keptOf(rows).map(row => x.values[row]), keptOf(rows).map(row => y.values[row])];
  const traces = GROUPS.map(([, name, label], i) => ({ x: [], y: [], colour: name, label, style: "points", rows: rowsOf[i] }));
  const fill = () => traces.forEach(t => { [t.x, t.y] = dataOf(t.rows); });
  fill();
  const words = (trace, i) => [`point ${index[keptOf(trace.rows)[i]]}`, reading(x.label, trace.x[i]), reading(y.label, trace.y[i])];
  const plot = scatterInto(around.plot(y.label), height, figure, traces, (trace, i) => {
    around.read(trace === null ? "" : words(trace, i).join(" · "));
  });
  const hasKinds = rowsOf.filter(rows => rows.length > 0).length > 1;
  traces.forEach((t, i) => hasKinds && t.rows.length > 0 && around.key(t.label, t.colour, "dot", show => plot.setSeries(i + 1, { show })));
  marks.forEach(mark => mark.label && around.key(mark.label, mark.colour, "", null));
  onPick(plot, (trace, i) => pick(keptOf(rowsOf[trace])[i]));
  around.onWhole(() => plot.setData(plot.data));
  return {
    renew() {
      fill();
      plot.setData([null, ...traces.map(t => [t.x, t.y])], false);
      plot.redraw();
    },
    remove() {
      drawn.delete(plot);
      plot.destroy();
      own.remove();
    },
  };
}

/** All plots of the points; `keep(isKept)` leaves out those that the reader does not want. */
function makePointPlots(host, points, columns, group, pick) {
  const keys = columns.slice(0, points.keys.length);
  const measures = columns.slice(points.keys.length);
  const state = { isKept: () => true };
  const rowsOf = GROUPS.map(([name]) => points.index.map((_, row) => row).filter(row => group(row) === name));
  const common = { rowsOf, state, pick, index: points.index };
  const front = [];
  if (points.objectives) {
    host.append(element("h3", {}, "Objectives"));
    const place = element("div");
    host.append(place);
    front.push(pointPlot(place, points.objectives.map(i => measures[i]), { ...common, height: 320 }));
  }
  let plots = [];
  const show = key => {
    plots.forEach(plot => plot.remove());
    plots = measures.map(measure => pointPlot(grid, [key, measure], { ...common, height: 240 }));
  };
  const grid = element("div", { class: "grid" });
  // A grid over one key is drawn as a line above.
  if (!points.is_grid || keys.length > 1) {
    host.append(element("h3", {}, "Measures over a key"));
    if (keys.length > 1) host.append(keyButtons(keys, show));
    host.append(grid);
    show(keys[0]);
  }
  return {
    keep(isKept) {
      state.isKept = isKept;
      [...front, ...plots].forEach(plot => plot.renew());
    },
  };
}

function keyButtons(keys, show) {
  const buttons = keys.map((key, i) => {
    const button = element("button", { "aria-pressed": String(i === 0), "data-key": key.name }, key.name);
    button.addEventListener("click", () => {
      buttons.forEach(b => b.setAttribute("aria-pressed", String(b === button)));
      show(key);
    });
    return button;
  });
  return element("div", { class: "choices" }, element("span", {}, "over"), ...buttons);
}
