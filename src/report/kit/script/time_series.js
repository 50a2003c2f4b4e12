// Measured and simulated over time, residuals below. All figures of a run show the same stretch.

/** Of each run: its plots, and the stretch that they show. */
const runs = new Map();

function runOf(name) {
  if (!runs.has(name)) runs.set(name, { plots: new Set(), range: null });
  return runs.get(name);
}

/** Shows a stretch of a run, in all of its plots: those to come as well. */
function showStretch(name, min, max) {
  const run = runOf(name);
  if (run.range && run.range.min === min && run.range.max === max) return;
  run.range = { min, max };
  run.plots.forEach(plot => plot.setScale("x", run.range));
}

/** Columns with an empty row wherever time leaps, which cuts the lines there. */
function withCuts(figure) {
  const columns = [figure.time_s, ...figure.lines.map(line => line.values)].map(column => [...column]);
  [...(figure.cuts ?? [])].reverse().forEach(cut => {
    const middle = 0.5 * (columns[0][cut - 1] + columns[0][cut]);
    columns.forEach((column, i) => column.splice(cut, 0, i === 0 ? middle : null));
  });
  return columns;
}

const lessThan = (was, is) => was.map((value, i) => (value === null || is[i] === null ? null : value - is[i]));

function drawTimeSeries(place, figure) {
  const { lines, time_s: times } = figure;
  const columns = withCuts(figure);
  const residuals = columns.slice(2).map(column => lessThan(columns[1], column));
  const csv = () => csvOf([["time_s", ...lines.map(l => l.label)], ...times.map((t, i) => [t, ...lines.map(l => l.values[i])])]);
  const around = frame(place, figure, csv);
  const run = runOf(figure.run);
  const read = plot => around.read(readTimes(plot, figure, columns, residuals));
  const style = (line, i) => ({ stroke: () => colour(line.colour), width: i === 0 ? 3.5 : 1.4, points: { show: false } });
  const above = timePlot(around.plot(figure.y_label), 270, figure.run, columns, lines.map(style), [], "", read);
  const plots = [above];
  if (residuals.length > 0) {
    const sd = figure.noise_sd;
    const marks = sd ? [{ colour: "blue", strip: [-2 * sd, 2 * sd] }] : [];
    const label = `measured − simulated${figure.unit ? ` (${figure.unit})` : ""}${sd ? "; band: ± 2 standard deviations of the noise" : ""}`;
    const styles = lines.slice(1).map((line, i) => style(line, i + 1));
    plots.push(timePlot(around.plot(label), 190, figure.run, [columns[0], ...residuals], styles, marks, "time (s)", read));
  }
  plots.forEach(plot => run.plots.add(plot));
  if (run.range) plots.forEach(plot => plot.setScale("x", run.range));
  lines.forEach((line, i) => around.key(line.label, line.colour, i === 0 ? "wide" : "", show => {
    above.setSeries(i + 1, { show });
    if (i > 0) plots[1].setSeries(i, { show });
  }));
  around.onWhole(() => showStretch(figure.run, times[0], times[times.length - 1]));
}

function timePlot(host, height, name, data, series, marks, xLabel, read) {
  const isMove = type => type === "mousemove" || type === "mouseleave";
  return plotInto(host, height, {
    scales: { x: { time: false }, y: { range: (_, low, high) => padded(low, high, 0.05) } },
    axes: axes(xLabel),
    series: [{}, ...series],
    cursor: { sync: { key: `run ${name}`, setSeries: false, filters: { pub: isMove, sub: isMove } }, drag: { x: true, y: false } },
    hooks: {
      drawAxes: [u => drawMarks(u, marks)],
      setCursor: [read],
      setScale: [(u, key) => key === "x" && runOf(name).plots.has(u) && showStretch(name, u.scales.x.min, u.scales.x.max)],
    },
  }, data);
}

function readTimes(plot, figure, columns, residuals) {
  const at = plot.cursor.idx;
  if (at === null || at === undefined) return "";
  const values = figure.lines.map((line, i) => {
    const off = i > 0 ? ` (off by ${digits(residuals[i - 1][at], 3)})` : "";
    return `${line.label} ${digits(columns[i + 1][at])}${off}`;
  });
  return [`time ${digits(columns[0][at], 6)} s`, ...values].join(" · ");
}
