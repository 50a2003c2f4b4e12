// Loops and points: the cursor reads the point that is nearest to it.

/** Draws a trace of a scatter plot. */
function painter(trace) {
  return paintedBy((ctx, xs, ys, across, up) => {
    ctx.strokeStyle = ctx.fillStyle = colour(trace.colour);
    const at = i => [across(xs[i]), up(ys[i])];
    if (trace.style !== "points") paintLine(ctx, xs, ys, at, WIDTHS[trace.style]);
    if (trace.style === "points" || hasDots(trace)) paintPoints(ctx, xs, ys, at);
  });
}

const isThere = (xs, ys, i) => xs[i] !== null && ys[i] !== null;

function paintLine(ctx, xs, ys, at, width) {
  ctx.lineWidth = width * uPlot.pxRatio;
  ctx.lineJoin = ctx.lineCap = "round";
  ctx.beginPath();
  for (let i = 0, isDown = false; i < xs.length; i++) {
    const here = isThere(xs, ys, i);
    if (here) ctx[isDown ? "lineTo" : "moveTo"](...at(i));
    isDown = here;
  }
  ctx.stroke();
}

function paintPoints(ctx, xs, ys, at) {
  const radius = (xs.length > 600 ? 2 : 3.2) * uPlot.pxRatio;
  for (let i = 0; i < xs.length; i++) {
    if (!isThere(xs, ys, i)) continue;
    ctx.beginPath();
    ctx.arc(...at(i), radius, 0, 2 * Math.PI);
    ctx.fill();
  }
}

/** Reach of the cursor, px. */
const REACH = 40;

/** Number of the trace, and of its point, that is nearest to the cursor. */
function nearestPoint(plot, reach = REACH) {
  const { left, top } = plot.cursor;
  let best = { trace: null, point: null, square: reach * reach };
  for (let k = 1; k < plot.data.length && left >= 0; k++) {
    const [xs, ys] = plot.data[k];
    for (let i = 0; plot.series[k].show && i < xs.length; i++) {
      if (!isThere(xs, ys, i)) continue;
      const square = (plot.valToPos(xs[i], "x") - left) ** 2 + (plot.valToPos(ys[i], "y") - top) ** 2;
      // Of points on the same spot the one that is drawn last.
      if (square <= best.square) best = { trace: k, point: i, square };
    }
  }
  return best;
}

/** A scatter plot of traces; `onRead(trace, point)` hears what the cursor is at; painters, ranges and its reach may be others. */
function scatterInto(host, height, figure, traces, onRead, { painters = traces.map(painter), ranges, reach } = {}) {
  let hit = { trace: null, point: null };
  const facets = [{ scale: "x", auto: true }, { scale: "y", auto: true }];
  const range = (_, low, high) => padded(low, high, 0.04);
  const [rangeX, rangeY] = ranges ?? [range, range];
  return plotInto(host, height, {
    mode: 2,
    scales: { x: { time: false, range: rangeX }, y: { range: rangeY } },
    axes: axes(figure.x_label),
    series: [{}, ...traces.map((trace, i) => ({ facets, stroke: () => colour(trace.colour), paths: painters[i], points: { show: false } }))],
    cursor: {
      drag: { x: true, y: true, uni: 20 },
      points: { size: 9, fill: (u, i) => colour(traces[i - 1].colour) },
      dataIdx: (u, i) => {
        if (i === 1) hit = nearestPoint(u, reach);
        return hit.trace === i ? hit.point : null;
      },
    },
    hooks: {
      drawAxes: [u => drawMarks(u, figure.marks)],
      setCursor: [() => onRead(hit.trace === null ? null : traces[hit.trace - 1], hit.point)],
    },
  }, [null, ...traces.map(trace => [trace.x, trace.y])]);
}

function drawScatter(place, figure) {
  const traces = tracesOf(figure);
  const around = frame(place, figure, plotCsv(figure));
  const plot = scatterInto(around.plot(figure.y_label), 300, figure, traces, (trace, i) => around.read(trace === null ? "" : [
    ...(trace.label ? [trace.label] : []), reading(figure.x_label, trace.x[i]), reading(figure.y_label, trace.y[i]),
  ].join(" · ")));
  traces.forEach((t, i) => {
    const style = t.style === "points" ? "dot" : t.style;
    if (t.label) around.key(t.label, t.colour, style, show => plot.setSeries(i + 1, { show }));
  });
  figure.marks.forEach(mark => mark.label && around.key(mark.label, mark.colour, "", null));
  around.onWhole(() => plot.setData(plot.data));
}
