// What the build takes from the library: units, presets, and the version.

/** `shown`: setting → unit → unit shown and factor. */
export const { units: UNITS, presets: PRESETS, groups: GROUPS, version: VERSION, page: PAGE } =
  JSON.parse(document.getElementById("tables").textContent);
