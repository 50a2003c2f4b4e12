// Colours and axes, which follow the page's style: light, dark, on paper.

const root = document.documentElement;
/** All plots that were drawn, with the element that holds each and its height there. */
const drawn = new Map();

const colour = name => (name.startsWith("#") ? name : getComputedStyle(root).getPropertyValue(`--${name}`).trim());

/** What else is to be painted again in other colours. */
const repainted = new Set();

function repaint() {
  drawn.forEach((_, plot) => plot.redraw());
  repainted.forEach(paint => paint());
}

const FONT = "12px system-ui, sans-serif";
const tick = value => digits(value, 10);
/** Room for the widest number; never less than five digits take, so that plots above each other have one left edge. */
const roomFor = (_, texts) => Math.max(56, 16 + 7 * Math.max(0, ...(texts ?? []).map(text => text.length)));

function axes(xLabel) {
  const common = {
    font: FONT,
    stroke: () => colour("soft"),
    grid: { stroke: () => colour("grid"), width: 1 },
    ticks: { stroke: () => colour("rule"), width: 1, size: 4 },
    values: (_, splits) => splits.map(tick),
  };
  const below = { label: xLabel, labelFont: FONT, labelSize: 18, labelGap: 0 };
  return [{ ...common, ...(xLabel ? below : {}), size: 28, space: 64 }, { ...common, size: roomFor, space: 36 }];
}

/** A range with room at both ends; of a single value, a range around it. */
function padded(low, high, share) {
  if (low === null || high === null || low === undefined || high === undefined) return [0, 1];
  const room = high > low ? share * (high - low) : 0.1 * Math.abs(low) || 1;
  return [low - room, high + room];
}

/** A plot in an element, of its width at any time. */
function plotInto(host, height, options, data) {
  const size = () => ({ width: Math.max(host.clientWidth, 160), height });
  const plot = new uPlot({ ...size(), legend: { show: false }, ...options }, data, host);
  drawn.set(plot, { host, height });
  new ResizeObserver(() => host.clientWidth > 0 && host.clientWidth !== plot.width && plot.setSize(size())).observe(host);
  onTouch(plot);
  return plot;
}

/** Strips across a plot and upright marks, drawn below its lines. */
function drawMarks(plot, marks) {
  const { ctx, bbox } = plot;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  for (const mark of marks) {
    ctx.fillStyle = ctx.strokeStyle = colour(mark.colour);
    if (mark.strip) {
      const [bottom, top] = mark.strip.map(value => plot.valToPos(value, "y", true));
      ctx.globalAlpha = 0.18;
      ctx.fillRect(bbox.left, top, bbox.width, bottom - top);
    } else {
      const x = plot.valToPos(mark.at, "x", true);
      ctx.globalAlpha = 1;
      ctx.lineWidth = 1.5 * uPlot.pxRatio;
      ctx.setLineDash([6, 4].map(length => length * uPlot.pxRatio));
      ctx.beginPath();
      ctx.moveTo(x, bbox.top);
      ctx.lineTo(x, bbox.top + bbox.height);
      ctx.stroke();
    }
  }
  ctx.restore();
}
