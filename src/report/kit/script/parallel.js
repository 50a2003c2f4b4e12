// Parallel coordinates: an upright axis for each column, a line for each point. A stretch drawn on an axis keeps the points
// that pass through it.

const PARALLEL_HEIGHT = 260;
const MARGIN = { top: 34, bottom: 22, side: 46 };
const MOST_AXES = 12;

/** `columns`: label and values each; `onBrush(isKept)` hears of every change of the stretches. */
function drawParallel(host, columns, order, onBrush) {
  const shown = columns.slice(0, MOST_AXES);
  const scales = shown.map(column => shares(column.values));
  const brushes = shown.map(() => null);
  const canvas = element("canvas", { class: "parallel", role: "img", "aria-label": "a line for each point across all columns" });
  host.append(canvas);
  const axisX = i => MARGIN.side + (i * (canvas.clientWidth - 2 * MARGIN.side)) / Math.max(shown.length - 1, 1);
  const inner = PARALLEL_HEIGHT - MARGIN.top - MARGIN.bottom;
  const yOf = share => MARGIN.top + (1 - share) * inner;
  const isKept = row => shown.every((column, i) => {
    if (!brushes[i]) return true;
    const share = column.values[row] === null ? NaN : scales[i].of(column.values[row]);
    return share >= brushes[i][0] && share <= brushes[i][1];
  });

  function paint() {
    const ratio = devicePixelRatio || 1;
    canvas.width = canvas.clientWidth * ratio;
    canvas.height = PARALLEL_HEIGHT * ratio;
    const ctx = canvas.getContext("2d");
    ctx.scale(ratio, ratio);
    const line = row => {
      ctx.beginPath();
      shown.forEach((column, i) => {
        const value = column.values[row];
        if (value !== null) ctx.lineTo(axisX(i), yOf(scales[i].of(value)));
      });
      ctx.stroke();
    };
    const rows = [...columns[0].values.keys()];
    ctx.strokeStyle = colour("silver");
    ctx.globalAlpha = 0.25;
    rows.filter(row => !isKept(row)).forEach(line);
    order(rows.filter(isKept)).forEach(({ row, name }) => {
      ctx.strokeStyle = colour(name);
      ctx.globalAlpha = rows.length > 300 ? 0.35 : 0.7;
      line(row);
    });
    ctx.globalAlpha = 1;
    shown.forEach((column, i) => paintAxis(ctx, column, i));
  }

  function paintAxis(ctx, column, i) {
    const x = axisX(i);
    ctx.strokeStyle = colour("grey");
    ctx.fillStyle = colour("ink");
    ctx.font = FONT;
    ctx.textAlign = i === 0 ? "left" : i === shown.length - 1 ? "right" : "center";
    const textX = i === 0 ? 2 : i === shown.length - 1 ? canvas.clientWidth - 2 : x;
    const room = axisX(1) - axisX(0) - 6;
    ctx.fillText(shortened(ctx, column.short, room), textX, 12);
    ctx.fillStyle = colour("soft");
    ctx.fillText(digits(scales[i].high, 3), textX, MARGIN.top - 8);
    ctx.fillText(digits(scales[i].low, 3), textX, PARALLEL_HEIGHT - 6);
    ctx.beginPath();
    ctx.moveTo(x, MARGIN.top);
    ctx.lineTo(x, MARGIN.top + inner);
    ctx.stroke();
    if (!brushes[i]) return;
    const [low, high] = brushes[i];
    ctx.globalAlpha = 0.35;
    ctx.fillStyle = colour("blue");
    ctx.fillRect(x - 8, yOf(high), 16, yOf(low) - yOf(high));
    ctx.globalAlpha = 1;
  }

  brushOn(canvas, {
    axisAt: x => shown.map((_, i) => Math.abs(axisX(i) - x)).reduce((best, off, i, all) => (off < all[best] ? i : best), 0),
    shareAt: y => Math.min(1, Math.max(0, 1 - (y - MARGIN.top) / inner)),
    set: (axis, brush) => {
      brushes[axis] = brush;
      paint();
      onBrush(isKept);
    },
  });
  new ResizeObserver(paint).observe(host);
  paint();
  return {
    paint,
    clear: () => { brushes.fill(null); paint(); onBrush(isKept); },
  };
}

/** A text cut to a width. */
function shortened(ctx, text, room) {
  let cut = text;
  while (cut.length > 3 && ctx.measureText(cut).width > room) cut = `${cut.slice(0, -2)}…`;
  return cut;
}

/** Draws stretches with mouse, pen or finger; a press without a way takes the axis's stretch away. */
function brushOn(canvas, { axisAt, shareAt, set }) {
  let held = null;
  const place = event => {
    const box = canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  canvas.addEventListener("pointerdown", event => {
    const [x, y] = place(event);
    held = { axis: axisAt(x), from: shareAt(y), y };
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", event => {
    if (!held) return;
    const to = shareAt(place(event)[1]);
    set(held.axis, [Math.min(held.from, to), Math.max(held.from, to)]);
  });
  canvas.addEventListener("pointerup", event => {
    if (held && Math.abs(place(event)[1] - held.y) < 3) set(held.axis, null);
    held = null;
  });
}
