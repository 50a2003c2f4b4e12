// The points as a table: a press on a head sorts, a field below it filters.

const ROWS_SHOWN = 100;

/** What a filter such as `> 3`, `<= 2e5`, `1..4` or `7` lets through. */
function filterOf(text) {
  const words = text.trim();
  if (words === "") return () => true;
  const between = /^(\S+)\s*\.\.\s*(\S+)$/.exec(words);
  if (between) return value => value !== null && value >= Number(between[1]) && value <= Number(between[2]);
  const [, sign, number] = /^(<=|>=|<|>|=)?\s*(.*)$/.exec(words);
  const limit = Number(number);
  const tests = { "<": v => v < limit, ">": v => v > limit, "<=": v => v <= limit, ">=": v => v >= limit };
  return value => value !== null && (tests[sign] ?? (v => digits(v) === digits(limit)))(value);
}

/** `columns`: short name, shown values; `tag(row)` marks rows; `pick(row)` hears of a press; `onFilter(isKept)` of filters. */
function drawPointTable(host, columns, { index, tag, pick, onFilter }) {
  const state = { column: null, isDown: false, isBrushed: () => true };
  const filters = columns.map(() => () => true);
  const body = element("tbody");
  const count = element("p", { class: "small" });
  const heads = columns.map((column, i) => {
    const button = element("button", { title: `sort by ${column.name}` }, column.short);
    button.addEventListener("click", () => {
      state.isDown = state.column === i && !state.isDown;
      state.column = i;
      fill();
    });
    return element("th", { "aria-sort": "none" }, button);
  });
  const fields = columns.map((column, i) => {
    const field = element("input", { size: 7, placeholder: "filter", "aria-label": `filter ${column.name}`, title: "> 3, <= 2e5, 1..4" });
    field.addEventListener("input", () => {
      filters[i] = filterOf(field.value);
      onFilter(isKept);
      fill();
    });
    return element("th", {}, field);
  });
  const head = element("thead", {}, element("tr", {}, element("th", {}, "point"), ...heads), element("tr", {}, element("th"), ...fields));
  host.append(element("div", { class: "box points" }, element("table", {}, head, body)), count);
  const isKept = row => columns.every((column, i) => filters[i](column.values[row]));

  function fill() {
    const rows = index.map((_, row) => row).filter(row => isKept(row) && state.isBrushed(row));
    if (state.column !== null) {
      const { values } = columns[state.column];
      const sign = state.isDown ? -1 : 1;
      rows.sort((a, b) => sign * ((values[a] ?? Infinity) - (values[b] ?? Infinity)));
    }
    heads.forEach((th, i) => th.setAttribute("aria-sort", state.column !== i ? "none" : state.isDown ? "descending" : "ascending"));
    body.replaceChildren(...rows.slice(0, ROWS_SHOWN).map(line));
    count.textContent = `${rows.length} of ${index.length} points${rows.length > ROWS_SHOWN ? `, ${ROWS_SHOWN} of them shown` : ""}.`;
  }

  function line(row) {
    const made = element("tr", { tabindex: 0 }, element("td", {}, `${index[row]}${tag(row)}`), ...columns.map(c => element("td", {}, digits(c.values[row]))));
    made.addEventListener("click", () => pick(row));
    made.addEventListener("keydown", event => event.key === "Enter" && pick(row));
    return made;
  }

  fill();
  return { brush: isBrushed => { state.isBrushed = isBrushed; fill(); }, isKept };
}
