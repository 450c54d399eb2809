// Files that the reader opens and saves, by the browser's own means.

import { PAGE } from "./tables.mjs";

/** Longest file that is read, bytes: the core's limit. */
export const LONGEST_FILE = 1 << 24;

/** Hand a text to the reader as a file. */
export function saveFile(name, text, type) {
  const url = URL.createObjectURL(new Blob([text], { type }));
  const link = Object.assign(document.createElement("a"), { href: url, download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}

/** The name of a file of something called so. */
export function fileName(name, ending) {
  const plain = name.normalize("NFKD").replace(/[^\w.-]+/gu, "-").replace(/^[-.]+|[-.]+$/g, "").slice(0, 60).toLowerCase();
  return `${plain || "engine"}.${ending}`;
}

/** Values as CSV: what begins like a formula is no formula. */
export function csvOf(rows) {
  const cell = (value) => {
    const text = typeof value === "string" && /^[=+\-@\t\r]/.test(value) ? `'${value}` : `${value ?? ""}`;
    return /[",\n\r]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
  };
  return rows.map((row) => `${row.map(cell).join(",")}\r\n`).join("");
}

/** The page that the library saves of an engine: the drawing modules, which this page has too, and figures. */
export function turningPage(figures) {
  const escape = (text) => text.replaceAll("&", "&amp;").replaceAll("<", "&lt;");
  const text = (id) => document.getElementById(id).textContent;
  const json = JSON.stringify(figures).replaceAll("<", "\\u003c");
  const filled = {
    title: escape(figures.name || "Engine"), style: text("turning"), body: "",
    script: `${text("drawing")}\npage(Full, ${json});`,
  };
  return PAGE.replace(/\$(\w+)/g, (_, name) => filled[name]);
}
