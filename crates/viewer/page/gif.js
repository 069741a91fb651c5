// Animated GIF: one palette of 255 colors for the whole film, so that what stands still does not flicker; one more index stands for a
// pixel that stays as it is.

const UNCHANGED = 255;

// How much of the difference between two neighbouring colors of the palette the dither covers, in codes.
const DITHER = 16;

// The ordered dither of Bayer, 8 x 8: from -1/2 to 1/2, in codes.
const BAYER = Int8Array.from({ length: 64 }, (_, i) => {
  let value = 0;
  for (let bit = 0; bit < 3; bit += 1) {
    const [x, y] = [(i >> bit) & 1, (i >> (3 + bit)) & 1];
    value = (value << 2) | ((x ^ y) << 1) | y;
  }
  return Math.round(DITHER * ((value + 0.5) / 64 - 0.5));
});

// The palette of so many colors: boxes of the cube of colors, of which the one whose colors differ most is cut, again and again. `images` have
// RGBA.
function palette(images, most) {
  // By 5 bits a color: how many there are, and the sums of their red, green and blue.
  const sums = new Float64Array(4 << 15);
  for (const { data } of images) {
    for (let i = 0; i < data.length; i += 4) {
      const bin = 4 * (((data[i] >> 3) << 10) | ((data[i + 1] >> 3) << 5) | (data[i + 2] >> 3));
      sums[bin] += 1;
      for (let c = 0; c < 3; c += 1) sums[bin + 1 + c] += data[i + c];
    }
  }
  const box = (colors) => {
    const [mean, spread] = [[0, 0, 0], [0, 0, 0]];
    const count = colors.reduce((all, [n]) => all + n, 0);
    for (const [n, ...color] of colors) color.forEach((value, c) => (mean[c] += (n * value) / count));
    for (const [n, ...color] of colors) color.forEach((value, c) => (spread[c] += n * (value - mean[c]) ** 2));
    const axis = spread.indexOf(Math.max(...spread));
    return { colors, mean, axis, worth: colors.length > 1 ? spread[axis] : 0 };
  };
  const there = [];
  for (let bin = 0; bin < sums.length; bin += 4) {
    const n = sums[bin];
    if (n > 0) there.push([n, sums[bin + 1] / n, sums[bin + 2] / n, sums[bin + 3] / n]);
  }
  const boxes = [box(there)];
  while (boxes.length < most) {
    const widest = boxes.reduce((one, other) => (other.worth > one.worth ? other : one));
    if (widest.worth === 0) break;
    const { colors, mean, axis } = widest;
    const isBelow = (color) => color[1 + axis] < mean[axis];
    boxes.splice(boxes.indexOf(widest), 1, box(colors.filter(isBelow)), box(colors.filter((color) => !isBelow(color))));
  }
  return boxes.map(({ mean }) => mean.map(Math.round));
}

// A function from a color to the index of the nearest one of the palette; it knows colors by 6 bits each.
function nearest(colors) {
  const known = new Int16Array(1 << 18).fill(-1);
  return (r, g, b) => {
    const place = ((r >> 2) << 12) | ((g >> 2) << 6) | (b >> 2);
    if (known[place] < 0) {
      let least = Infinity;
      colors.forEach((color, index) => {
        const apart = (color[0] - r) ** 2 + (color[1] - g) ** 2 + (color[2] - b) ** 2;
        if (apart < least) [least, known[place]] = [apart, index];
      });
    }
    return known[place];
  };
}

// The compressed indices of a frame, in blocks of 255 bytes: LZW with codes of 9 to 12 bits.
function compressed(indices) {
  const [CLEAR, END, FIRST, MOST] = [256, 257, 258, 4096];
  const bytes = [];
  let [bits, held] = [0, 0];
  let [size, free] = [9, FIRST];
  // What follows a code by an index.
  const table = new Uint16Array(MOST << 8);
  const put = (code) => {
    held |= code << bits;
    bits += size;
    for (; bits >= 8; bits -= 8) {
      bytes.push(held & 255);
      held >>>= 8;
    }
  };
  put(CLEAR);
  let code = indices[0];
  for (let i = 1; i < indices.length; i += 1) {
    const index = indices[i];
    const longer = table[(code << 8) | index];
    if (longer > 0) {
      code = longer;
      continue;
    }
    put(code);
    if (free === MOST) {
      put(CLEAR);
      table.fill(0);
      [size, free] = [9, FIRST];
    } else {
      if (free === 1 << size) size += 1;
      table[(code << 8) | index] = free;
      free += 1;
    }
    code = index;
  }
  put(code);
  // Whoever reads has made a code of this one, too.
  if (free === 1 << size && size < 12) size += 1;
  put(END);
  if (bits > 0) bytes.push(held & 255);
  const blocks = [8];
  for (let i = 0; i < bytes.length; i += 255) {
    const block = bytes.slice(i, i + 255);
    blocks.push(block.length, ...block);
  }
  return Uint8Array.from([...blocks, 0]);
}

// A film of images (`ImageData`) of one size, so many a second, that goes round for ever; `told` is awaited with the share that is done.
export async function gif(images, rate, told) {
  const { width, height } = images[0];
  const colors = palette(images, UNCHANGED);
  const indexOf = nearest(colors);
  const short = (number) => [number & 255, number >> 8];
  const flat = Array.from({ length: 256 }, (_, i) => colors[i] ?? [0, 0, 0]).flat();
  const text = (word) => Array.from(word, (letter) => letter.charCodeAt(0));
  const parts = [Uint8Array.from([
    ...text("GIF89a"), ...short(width), ...short(height), 0xf7, 0, 0, ...flat,
    // Again and again.
    0x21, 0xff, 11, ...text("NETSCAPE2.0"), 3, 1, 0, 0, 0,
  ])];
  let shown = null;
  for (const [number, { data }] of images.entries()) {
    const indices = new Uint8Array(width * height);
    for (let i = 0; i < indices.length; i += 1) {
      const shift = BAYER[(((i / width) & 7) << 3) | (i % width & 7)];
      const shifted = (c) => Math.min(255, Math.max(0, data[4 * i + c] + shift));
      indices[i] = indexOf(shifted(0), shifted(1), shifted(2));
    }
    const changes = shown ? indices.map((index, i) => (index === shown[i] ? UNCHANGED : index)) : indices;
    shown = indices;
    // Hundredths of a second, which add up to the whole.
    const end = (count) => Math.round((100 * count) / rate);
    parts.push(Uint8Array.from([0x21, 0xf9, 4, 5, ...short(end(number + 1) - end(number)), UNCHANGED, 0]));
    parts.push(Uint8Array.from([0x2c, 0, 0, 0, 0, ...short(width), ...short(height), 0]));
    parts.push(compressed(changes));
    await told((number + 1) / images.length);
  }
  parts.push(Uint8Array.of(0x3b));
  return new Blob(parts, { type: "image/gif" });
}
