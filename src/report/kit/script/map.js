// A map over two keys: a cell for each point of a grid, the darker the more a measure is there.

/** Half the distance to the next of the different values: how far a cell reaches. */
function halfStep(values) {
  const different = [...new Set(values)].sort((a, b) => a - b);
  const steps = different.slice(1).map((value, i) => value - different[i]);
  return steps.length ? 0.5 * Math.min(...steps) : 0.5 * Math.abs(different[0] ?? 1) || 0.5;
}

/** Share of a value between the least and the greatest. */
function shares(values) {
  const there = values.filter(value => value !== null);
  const [low, high] = [Math.min(...there), Math.max(...there)];
  return { low, high, of: value => (high > low ? (value - low) / (high - low) : 0.5) };
}

const mixed = share => `color-mix(in oklab, ${colour("heat")} ${Math.round(100 * share)}%, ${colour("pale")})`;

function cellPainter(x, y, values) {
  const [halfX, halfY] = [halfStep(x), halfStep(y)];
  const share = shares(values);
  return paintedBy((ctx, xs, ys, across, up) => {
    xs.forEach((value, i) => {
      if (values[i] === null) return;
      const [from, to, low, high] = [across(value - halfX), across(value + halfX), up(ys[i] - halfY), up(ys[i] + halfY)];
      ctx.fillStyle = mixed(share.of(values[i]));
      ctx.fillRect(Math.floor(from), Math.floor(high), Math.ceil(to - from) + 1, Math.ceil(low - high) + 1);
    });
  });
}

/** A map in a figure of its own; `pick(row)` hears of a press. */
function drawMap(place, points, measure, pick) {
  const [x, y] = points.keys.map(shownValues);
  const figure = { x_label: points.keys[0].label, y_label: points.keys[1].label, marks: [], file: `map_${measure.name}.csv`, title: measure.label };
  const csv = () => csvOf([[...points.keys.map(k => k.name), measure.name], ...measure.values.map((value, i) => [points.keys[0].values[i], points.keys[1].values[i], value])]);
  const around = frame(place, figure, csv);
  const { low, high } = shares(measure.values);
  const scale = element("span", { class: "scale" }, digits(low, 4), element("i"), digits(high, 4));
  place.querySelector(".tools").prepend(scale);
  const cells = values => { const half = halfStep(values); return (_, a, b) => [a - half, b + half]; };
  const traces = [{ x, y, colour: "heat", style: "points" }];
  const plot = scatterInto(around.plot(figure.y_label), 320, figure, traces, (trace, i) => {
    around.read(trace === null ? "" : [reading(figure.x_label, x[i]), reading(figure.y_label, y[i]), reading(measure.label, measure.values[i])].join(" · "));
  }, { painters: [cellPainter(x, y, measure.values)], ranges: [cells(x), cells(y)], reach: Infinity });
  onPick(plot, (_, i) => pick(i), Infinity);
  around.onWhole(() => plot.setData(plot.data));
}
