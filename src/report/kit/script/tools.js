// What stands around a plot: title, keys that switch lines on and off, the way back from a zoom, the CSV, what the cursor reads.

/** The frame of a figure; `figure` is its data, `place` its element. */
function frame(place, figure, csv) {
  const keys = element("div", { class: "tools" });
  const readout = element("p", { class: "readout" });
  const plots = element("div");
  const whole = element("button", { title: "the whole again; so does a double click" }, "whole");
  keys.append(element("span", { class: "gap" }), whole, download(figure.file, csv, figure.whole));
  const heads = figure.title ? [element("h3", {}, figure.title)] : [];
  const notes = (figure.notes ?? []).map(note => element("p", { class: "small" }, note));
  place.prepend(...heads, ...notes, keys, plots, readout);
  const caption = place.querySelector("figcaption");
  if (!caption.textContent) caption.remove();
  return {
    /** A place for a plot, with what its y axis shows above it. */
    plot(label) {
      const host = element("div", { class: "plot" });
      plots.append(element("p", { class: "axis" }, label), host);
      return host;
    },
    /** A key; `toggle(isShown)` switches what it stands for. */
    key(label, name, style, toggle) {
      const swatch = element("i");
      swatch.style.setProperty("--k", name.startsWith("#") ? name : `var(--${name})`);
      const button = element("button", { class: `key ${style}`, "aria-pressed": "true" }, swatch, label);
      if (!toggle) button.disabled = true;
      button.addEventListener("click", () => {
        const isShown = button.getAttribute("aria-pressed") === "false";
        button.setAttribute("aria-pressed", isShown);
        toggle(isShown);
      });
      keys.insertBefore(button, keys.querySelector(".gap"));
    },
    onWhole: act => whole.addEventListener("click", act),
    read: words => { readout.textContent = words; },
  };
}

/** `time 3.2 s`: a label such as `time (s)` with a value. */
function reading(label, value) {
  const parts = /^(.*) \(([^()]*)\)$/.exec(label);
  const unit = parts && parts[2] !== "-" && parts[2] !== "1" ? ` ${parts[2]}` : "";
  return `${parts ? parts[1] : label} ${digits(value)}${unit}`;
}

/** What uPlot asks to draw a series: `draw` gets the canvas, clipped to the axes, and the ways from values to its points. What uPlot gets back is
 * empty, so that it asks again at every change of a scale. */
function paintedBy(draw) {
  return (plot, index) => {
    uPlot.orient(plot, index, (series, xs, ys, sx, sy, toX, toY, left, top, width, height) => {
      const { ctx } = plot;
      ctx.save();
      ctx.beginPath();
      ctx.rect(left, top, width, height);
      ctx.clip();
      draw(ctx, xs, ys, x => toX(x, sx, width, left), y => toY(y, sy, height, top));
      ctx.restore();
    });
    return null;
  };
}
