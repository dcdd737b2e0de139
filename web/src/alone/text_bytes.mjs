// Bytes as the text of an element: 13 bits in two of 91 characters, all from ! to ~ but ", < and \. That is 8 % shorter than base64.
// web/wasm/site.mjs writes them and puts bytesOfText() in front of the page; packed.ts reads them in the page.

const digits = [...Array(94).keys()].map((n) => String.fromCharCode(33 + n)).filter((one) => !'"<\\'.includes(one));

/** @param {Uint8Array} bytes */
export function textOf(bytes) {
  let text = "";
  let held = 0;
  let bits = 0;
  const put = () => (text += digits[Math.floor((held & 8191) / 91)] + digits[(held & 8191) % 91]);
  for (const byte of bytes) {
    held |= byte << bits;
    bits += 8;
    if (bits < 13) continue;
    put();
    held >>>= 13;
    bits -= 13;
  }
  if (bits > 0) put();
  return text;
}

/**
 * Stands alone, as its text becomes a script.
 * @param {string} text
 * @param {number} count of bytes
 * @returns {Uint8Array<ArrayBuffer>}
 */
export function bytesOfText(text, count) {
  /** @param {number} at */
  const digit = (at) => {
    const code = text.charCodeAt(at);
    return code - 33 - Number(code > 34) - Number(code > 60) - Number(code > 92);
  };
  const bytes = new Uint8Array(count);
  let held = 0;
  let bits = 0;
  let next = 0;
  for (let at = 0; next < count; at += 2) {
    held |= (digit(at) * 91 + digit(at + 1)) << bits;
    for (bits += 13; bits >= 8 && next < count; bits -= 8) {
      bytes[next++] = held & 255;
      held >>>= 8;
    }
  }
  return bytes;
}
