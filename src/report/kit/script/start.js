// Figures are drawn as they come into view; all of them for paper.

const figures = JSON.parse(document.getElementById("figures").textContent);
const DRAW = { TimeSeries: drawTimeSeries, Curve: drawCurve, Scatter: drawScatter, Exploration: drawExploration };
const waiting = new Set(document.querySelectorAll("figure.chart"));

function draw(place) {
  if (!waiting.delete(place)) return;
  const figure = figures[place.dataset.figure];
  DRAW[figure.type](place, figure);
}

const seen = new IntersectionObserver(entries => {
  entries.filter(entry => entry.isIntersecting).forEach(entry => {
    seen.unobserve(entry.target);
    draw(entry.target);
  });
}, { rootMargin: "400px" });
waiting.forEach(place => seen.observe(place));

document.querySelectorAll(".chooser").forEach((chooser, i) => {
  const show = makeChooser(chooser);
  if (i === 0) linkStretches(show, chooser);
});

document.querySelectorAll("figure.table").forEach(place => {
  const cells = row => [...row.cells].map(cell => cell.textContent);
  const csv = () => csvOf([...place.querySelectorAll("tr")].map(cells));
  place.append(element("p", { class: "tools" }, download(place.dataset.file, csv)));
});

matchMedia("(prefers-color-scheme: dark)").addEventListener("change", repaint);

function fit() {
  repainted.forEach(paint => paint());
  // Two figures to a sheet.
  const share = root.classList.contains("paper") ? 0.72 : 1;
  drawn.forEach(({ host, height }, plot) => plot.setSize({ width: Math.max(host.clientWidth, 160), height: Math.round(share * height) }));
}

addEventListener("beforeprint", () => {
  root.classList.add("paper");
  document.querySelectorAll("details").forEach(details => { details.open = true; });
  [...waiting].forEach(draw);
  fit();
});
addEventListener("afterprint", () => {
  root.classList.remove("paper");
  fit();
});
