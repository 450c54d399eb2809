// What the build takes from the library: units, presets, declarations of arguments, and the version.

/** `shown`: setting → unit → unit shown and factor. */
export const { units: UNITS, declared: DECLARED, of_loads: OF_LOADS, presets: PRESETS, groups: GROUPS, version: VERSION, page: PAGE } =
  JSON.parse(document.getElementById("tables").textContent);
