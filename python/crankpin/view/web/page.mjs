// The file: a view that fills the page.

/** Show an engine in the page by `Full` or `Compact`, and give its view to scripts as `crankpin`. */
export function page(View, figures) {
  const view = new View(figures, { keysOn: document });
  document.body.append(view.element);
  const name = document.title;
  view.listeners.add(() => { document.title = `${name}${view.header.changes.textContent}`; });
  globalThis.crankpin = view;
  if (location.hash === "#playing") view.set({ playing: true });
}
