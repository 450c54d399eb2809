// What the page begins with: styles, texts, scripts and the core stand packed in it.

import { decompressed } from "./lzma.mjs";

/** The bytes that were packed: seven bits in a letter, as `build.py` writes them. */
function packed() {
  const text = document.getElementById("packed").textContent;
  const bytes = new Uint8Array((text.length * 7) >> 3);
  let held = 0;
  let bits = 0;
  let count = 0;
  for (let k = 0; k < text.length; k++) {
    held = (held << 7) | (text.charCodeAt(k) & 127);
    bits += 7;
    if (bits >= 8) bytes[count++] = held >> (bits -= 8);
  }
  return bytes;
}

async function unpack() {
  const bytes = decompressed(packed(), Number(document.getElementById("packed").dataset.size));
  // A line of elements, and the core behind it.
  const end = bytes.indexOf(10);
  for (const [tag, id, type, textContent] of JSON.parse(new TextDecoder().decode(bytes.subarray(0, end)))) {
    document.head.append(Object.assign(document.createElement(tag), { id, type, textContent }));
  }
  await globalThis.begin(bytes.subarray(end + 1));
}

unpack().catch((error) => {
  const said = document.createElement("p");
  said.setAttribute("role", "alert");
  said.textContent = `The workbench could not start: ${error.message}`;
  document.body.append(said);
  throw error;
});
