// Fingers: one moves the cursor sideways, two zoom along x. Up and down, the page scrolls.

function onTouch(plot) {
  const left = touch => touch.clientX - plot.over.getBoundingClientRect().left;
  let held = null;
  plot.over.addEventListener("touchstart", event => {
    held = event.touches.length === 2 ? [...event.touches].map(touch => plot.posToVal(left(touch), "x")) : null;
  }, { passive: true });
  plot.over.addEventListener("touchmove", event => {
    const [one, other] = event.touches;
    if (!other) {
      plot.setCursor({ left: left(one), top: one.clientY - plot.over.getBoundingClientRect().top }, true, true);
      return;
    }
    if (!held) return;
    event.preventDefault();
    // The values that lay below the fingers stay below them.
    const [a, b] = [left(one), left(other)];
    if (Math.abs(b - a) < 10) return;
    const perPixel = (held[1] - held[0]) / (b - a);
    const min = held[0] - a * perPixel;
    const max = min + plot.over.clientWidth * perPixel;
    if (max > min) plot.setScale("x", { min, max });
  }, { passive: false });
}
