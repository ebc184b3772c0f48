"use strict";
// Decompression (RFC 1951). Browsers can decompress too, but asynchronously: the whole page would have to
// wait for the result.

/** For each symbol of a copy: its least length or distance, and the number of additional bits. */
function copies(count, each, least) {
  return Array.from({ length: count }, (_, i) => {
    const bits = Math.max(0, Math.floor(i / each) - 1);
    least += 1 << bits;
    return { least: least - (1 << bits), bits };
  });
}
const LENGTHS = [...copies(28, 4, 3), { least: 258, bits: 0 }];
const DISTANCES = copies(30, 2, 1);
/** The order of the lengths of codes for lengths of codes. */
const CODES = [16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15];
const LONGEST = 15;

/** For all next bits, 16 times the symbol of the code, plus the code's length; from the lengths of codes. */
function symbolsOf(lengths) {
  const symbols = new Uint16Array(1 << LONGEST);
  for (let length = 1, code = 0; length <= LONGEST; length++, code <<= 1) {
    for (let symbol = 0; symbol < lengths.length; symbol++) {
      if (lengths[symbol] !== length) continue;
      let reversed = 0;
      for (let i = 0; i < length; i++) reversed |= ((code >> i) & 1) << (length - 1 - i);
      for (let i = reversed; i < symbols.length; i += 1 << length) symbols[i] = (symbol << 4) | length;
      code++;
    }
  }
  return symbols;
}

/** The decompressed bytes, given their number. */
function inflated(bytes, count) {
  const out = new Uint8Array(count);
  let end = 0, at = 0, bits = 0, held = 0;
  const hold = () => {
    for (; held < LONGEST; held += 8) bits |= bytes[at++] << held;
  };
  const take = many => {
    hold();
    const taken = bits & ((1 << many) - 1);
    bits >>>= many;
    held -= many;
    return taken;
  };
  const next = symbols => {
    hold();
    const symbol = symbols[bits & ((1 << LONGEST) - 1)];
    bits >>>= symbol & 15;
    held -= symbol & 15;
    return symbol >> 4;
  };
  const copied = ({ least, bits }) => least + take(bits);
  for (let isLast = 0; !isLast;) {
    isLast = take(1);
    const kind = take(2);
    if (kind === 0) {
      // Uncompressed bytes, from the next whole byte on: `held` bits are read ahead.
      at -= held >> 3;
      const length = bytes[at] | (bytes[at + 1] << 8);
      out.set(bytes.subarray(at + 4, at + 4 + length), end);
      [at, bits, held, end] = [at + 4 + length, 0, 0, end + length];
      continue;
    }
    const { literals, distances } = kind === 1 ? fixedCodes() : codes(take, next);
    for (let symbol; (symbol = next(literals)) !== 256;) {
      if (symbol < 256) {
        out[end++] = symbol;
        continue;
      }
      const length = copied(LENGTHS[symbol - 257]);
      const distance = copied(DISTANCES[next(distances)]);
      for (const stop = end + length; end < stop; end++) out[end] = out[end - distance];
    }
  }
  return out;
}

function fixedCodes() {
  const lengths = Array.from({ length: 288 }, (_, i) => (i < 144 ? 8 : i < 256 ? 9 : i < 280 ? 7 : 8));
  return { literals: symbolsOf(lengths), distances: symbolsOf(new Array(30).fill(5)) };
}

/** The codes at the beginning of a block. */
function codes(take, next) {
  const [literals, distances, count] = [take(5) + 257, take(5) + 1, take(4) + 4];
  const first = new Array(19).fill(0);
  for (let i = 0; i < count; i++) first[CODES[i]] = take(3);
  const symbols = symbolsOf(first);
  const lengths = [];
  while (lengths.length < literals + distances) {
    const symbol = next(symbols);
    if (symbol < 16) lengths.push(symbol);
    else {
      // The last length, or 0, several times.
      const [value, least, bits] = [[lengths.at(-1), 3, 2], [0, 3, 3], [0, 11, 7]][symbol - 16];
      for (let more = least + take(bits); more > 0; more--) lengths.push(value);
    }
  }
  return { literals: symbolsOf(lengths.slice(0, literals)), distances: symbolsOf(lengths.slice(literals)) };
}
