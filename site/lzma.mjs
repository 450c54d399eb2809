// LZMA, of which browsers have no decoder: a quarter less than what gzip makes of the page.
//
// The stream is raw: three bits of the byte before as context of a literal (lc = 3), none of its place
// (lp = pb = 0), as `build.py` writes it. After the specification in Igor Pavlov's LZMA SDK.

/** Where the probabilities of each choice begin; those of the lengths of new matches and of repeated ones alike. */
const [MATCH, REPEATED, FIRST, SECOND, THIRD, LONG] = [0, 12, 24, 36, 48, 60];
const [SLOT, PLACE, ALIGNED, LENGTH, LENGTH_REPEATED, LITERAL] = [72, 328, 456, 472, 752, 1032];
const COUNT = LITERAL + 0x300 * 8;

/** The `size` bytes that were compressed. */
export function decompressed(packed, size) {
  const bytes = new Uint8Array(size);
  const odds = new Uint16Array(COUNT).fill(1024);
  const last = [0, 0, 0, 0];
  let [count, state] = [0, 0];
  // In an array, for numbers of 32 bits that closures change are objects elsewhere: twice as fast.
  const coder = new Uint32Array([0xffffffff, new DataView(packed.buffer, packed.byteOffset).getUint32(1)]);
  const [RANGE, CODE] = [0, 1];
  let read = 5;

  const shift = () => {
    if (coder[RANGE] >= 0x1000000) return;
    coder[RANGE] <<= 8;
    coder[CODE] = (coder[CODE] << 8) | packed[read++];
  };
  const bit = (at) => {
    const bound = (coder[RANGE] >>> 11) * odds[at];
    const one = coder[CODE] >= bound;
    if (one) {
      coder[RANGE] -= bound;
      coder[CODE] -= bound;
      odds[at] -= odds[at] >> 5;
    } else {
      coder[RANGE] = bound;
      odds[at] += (2048 - odds[at]) >> 5;
    }
    shift();
    return one ? 1 : 0;
  };
  /** A number of so many bits, the highest first. */
  const tree = (at, bits) => {
    let node = 1;
    for (let k = 0; k < bits; k++) node = 2 * node + bit(at + node);
    return node - (1 << bits);
  };
  /** And the lowest first. */
  const reversed = (at, bits) => {
    let [node, value] = [1, 0];
    for (let k = 0; k < bits; k++) {
      const found = bit(at + node);
      node = 2 * node + found;
      value |= found << k;
    }
    return value;
  };
  const direct = (bits) => {
    let value = 0;
    for (let k = 0; k < bits; k++) {
      coder[RANGE] >>>= 1;
      const one = coder[CODE] >= coder[RANGE];
      if (one) coder[CODE] -= coder[RANGE];
      value = 2 * value + (one ? 1 : 0);
      shift();
    }
    return value;
  };
  const length = (at) => {
    if (!bit(at)) return 2 + tree(at + 2, 3);
    return bit(at + 1) ? 18 + tree(at + 18, 8) : 10 + tree(at + 10, 3);
  };
  const distance = (long) => {
    const slot = tree(SLOT + 64 * Math.min(long - 2, 3), 6);
    if (slot < 4) return slot;
    const bits = (slot >> 1) - 1;
    const high = (2 | (slot & 1)) * 2 ** bits;
    if (slot < 14) return high + reversed(PLACE + high - slot, bits);
    return high + 16 * direct(bits - 4) + reversed(ALIGNED, 4);
  };
  const literal = (at, matched) => {
    let node = 1;
    // What differs from the byte at the last distance is told by other probabilities until it does.
    for (let same = matched; node < 256;) {
      if (same < 0) {
        node = 2 * node + bit(at + node);
        continue;
      }
      const expected = (same >> 7) & 1;
      const found = bit(at + 256 * (1 + expected) + node);
      node = 2 * node + found;
      same = found === expected ? (same << 1) & 255 : -1;
    }
    return node;
  };

  const copy = (long) => {
    for (const end = Math.min(count + long, size); count < end; count++) bytes[count] = bytes[count - last[0] - 1];
  };

  while (count < size) {
    const before = count > 0 ? bytes[count - 1] : 0;
    if (!bit(MATCH + state)) {
      const matched = state < 7 ? -1 : bytes[count - last[0] - 1];
      bytes[count++] = literal(LITERAL + 0x300 * (before >> 5), matched);
      state = state < 4 ? 0 : state - (state < 10 ? 3 : 6);
      continue;
    }
    if (!bit(REPEATED + state)) {
      const long = length(LENGTH);
      last.unshift(distance(long));
      last.pop();
      copy(long);
      state = state < 7 ? 7 : 10;
    } else if (bit(FIRST + state)) {
      const which = bit(SECOND + state) ? 2 + bit(THIRD + state) : 1;
      last.unshift(...last.splice(which, 1));
      copy(length(LENGTH_REPEATED));
      state = state < 7 ? 8 : 11;
    } else if (bit(LONG + state)) {
      copy(length(LENGTH_REPEATED));
      state = state < 7 ? 8 : 11;
    } else {
      copy(1);
      state = state < 7 ? 9 : 11;
    }
  }
  return bytes;
}
