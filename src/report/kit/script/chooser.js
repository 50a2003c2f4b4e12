// One figure of many, by its run and its channel.

function makeChooser(chooser) {
  const state = {};
  chooser.querySelectorAll("[aria-pressed=true][data-axis]").forEach(({ dataset }) => { state[dataset.axis] = dataset.value; });
  const all = [...chooser.querySelectorAll("figure")];
  const show = change => {
    Object.assign(state, change);
    const found = all.find(figure => figure.dataset.run === state.run && figure.dataset.channel === state.channel);
    all.forEach(figure => { figure.hidden = figure !== found; });
    chooser.querySelector(".absent").hidden = found !== undefined;
    chooser.querySelectorAll("[data-axis]").forEach(button => {
      button.setAttribute("aria-pressed", state[button.dataset.axis] === button.dataset.value);
    });
    return found;
  };
  chooser.querySelectorAll("[data-axis]").forEach(button => {
    button.addEventListener("click", () => show({ [button.dataset.axis]: button.dataset.value }));
  });
  return show;
}

/** Marked stretches of runs show themselves in the page's first chooser. */
function linkStretches(show, chooser) {
  document.querySelectorAll(".lane [data-from]").forEach(mark => mark.addEventListener("click", () => {
    const found = show({ run: mark.dataset.run }) ?? chooser.querySelector(`figure[data-run="${mark.dataset.run}"]`);
    const [from, to] = [Number(mark.dataset.from), Number(mark.dataset.to)];
    const room = Math.max(0.25 * (to - from), 0.2);
    if (found) showStretch(figures[found.dataset.figure].run, from - room, to + room);
    chooser.scrollIntoView({ behavior: "smooth" });
  }));
}
