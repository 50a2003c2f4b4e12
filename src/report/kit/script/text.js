// Numbers, elements, CSV.

/** A number with so many significant digits, as short as they allow. */
function digits(value, count = 5) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  const size = Math.abs(value);
  const isPlain = value === 0 || (size >= 1e-4 && size < 1e6);
  return isPlain ? String(Number(value.toPrecision(count))) : String(Number(value.toPrecision(count)).toExponential());
}

/** An element with attributes and children; text is never read as HTML. */
function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  Object.entries(attributes).forEach(([name, value]) => made.setAttribute(name, value));
  made.append(...children);
  return made;
}

const csvCell = cell => (/[",\r\n]/.test(cell) ? `"${cell.replaceAll('"', '""')}"` : cell);

/** Rows of cells (texts, numbers, null) as CSV. */
function csvOf(rows) {
  return rows.map(row => row.map(cell => csvCell(String(cell ?? ""))).join(",")).join("\n") + "\n";
}

/** A link that saves what `text` returns; `href`, if it is given, is a file beside the page instead. */
function download(name, text, href) {
  const link = element("a", { href: href ?? "#", download: name }, "CSV");
  if (href) link.title = "all samples: a file beside this page";
  if (!href) link.addEventListener("click", () => {
    const url = URL.createObjectURL(new Blob([text()], { type: "text/csv" }));
    link.href = url;
    setTimeout(() => URL.revokeObjectURL(url), 10000);
  });
  return link;
}
