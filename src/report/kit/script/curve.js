// Lines that all run to the right: an upright cursor reads all of them.

/** Traces with an x of their own each. */
function tracesOf(figure) {
  let x = [];
  return figure.traces.map(trace => ({ ...trace, x: (x = trace.x ?? x) }));
}

const plotCsv = figure => () => csvOf([
  ["series", "x", "y"],
  ...tracesOf(figure).flatMap(t => t.x.map((x, i) => [t.label, x, t.y[i]]).filter(row => row[1] !== null && row[2] !== null)),
  ...(figure.area ? areaRows(figure.area) : []),
]);

const areaRows = area => ["low", "high"].flatMap(end => area[end].map((y, i) => [`${area.label}, ${end}`, area.x[i], y]));

/** The place nearest to one, of a column with holes, that has a value. */
function nearestValue(column, at) {
  for (let off = 0; off < column.length; off++) {
    if (column[at - off] !== null && column[at - off] !== undefined) return at - off;
    if (column[at + off] !== null && column[at + off] !== undefined) return at + off;
  }
  return null;
}

/** Whether a line is of so few points that each is shown. */
const hasDots = trace => trace.style === "thin" && trace.y.length <= 60;

const WIDTHS = { broad: 3.5, thin: 1.6 };

function drawCurve(place, figure) {
  const traces = tracesOf(figure);
  const { area } = figure;
  const tables = traces.map(t => [t.x, t.y]).concat(area ? [[area.x, area.high], [area.x, area.low]] : []);
  const data = tables.length ? uPlot.join(tables) : [[], []];
  const around = frame(place, figure, plotCsv(figure));
  const host = around.plot(figure.y_label);
  const dots = t => ({ show: hasDots(t), size: 6, fill: () => colour(t.colour) });
  const lines = traces.map(t => ({ label: t.label, stroke: () => colour(t.colour), width: WIDTHS[t.style], points: dots(t) }));
  const ends = area ? [1, 2].map(() => ({ stroke: () => colour(area.colour), width: 0.8, points: { show: false } })) : [];
  const count = lines.length;
  const plot = plotInto(host, 260, {
    scales: { x: { time: false }, y: { range: (_, low, high) => padded(low, high, 0.05) } },
    axes: axes(figure.x_label),
    series: [{}, ...lines, ...ends],
    bands: area ? [{ series: [count + 1, count + 2], fill: () => `color-mix(in srgb, ${colour(area.colour)} 22%, transparent)` }] : [],
    cursor: { dataIdx: (u, i, at) => nearestValue(u.data[i], at) },
    hooks: {
      drawAxes: [u => drawMarks(u, figure.marks)],
      setCursor: [u => around.read(readCurve(u, figure, traces))],
    },
  }, data);
  traces.forEach((t, i) => t.label && around.key(t.label, t.colour, t.style, show => plot.setSeries(i + 1, { show })));
  if (area) {
    around.key(area.label, area.colour, "wide", show => [1, 2].forEach(k => plot.setSeries(count + k, { show })));
  }
  figure.marks.forEach(mark => mark.label && around.key(mark.label, mark.colour, "", null));
  around.onWhole(() => plot.setData(plot.data));
}

function readCurve(plot, figure, traces) {
  const at = plot.cursor.idx;
  if (at === null || at === undefined) return "";
  const values = traces.map((t, i) => {
    const own = plot.cursor.idxs[i + 1];
    return plot.series[i + 1].show && own !== null ? `${t.label || figure.y_label} ${digits(plot.data[i + 1][own])}` : null;
  });
  return [reading(figure.x_label, plot.data[0][at]), ...values.filter(Boolean)].join(" · ");
}
