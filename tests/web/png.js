// Reads the pixels of the PNG files that Chromium makes: 8 bits, RGB or RGBA, not interlaced.
"use strict";
const { inflateSync } = require("zlib");

function readPng(bytes) {
  const width = bytes.readUInt32BE(16), height = bytes.readUInt32BE(20), channels = { 2: 3, 6: 4 }[bytes[25]];
  if (bytes[24] !== 8 || !channels || bytes[28] !== 0) throw new Error("an unexpected kind of PNG");
  const parts = [];
  for (let at = 8; at < bytes.length; at += bytes.readUInt32BE(at) + 12)
    if (bytes.toString("latin1", at + 4, at + 8) === "IDAT") parts.push(bytes.subarray(at + 8, at + 8 + bytes.readUInt32BE(at)));
  const raw = inflateSync(Buffer.concat(parts)), row = width * channels, pixels = Buffer.alloc(row * height);
  for (let y = 0; y < height; y++) {
    const filter = raw[y * (row + 1)];
    for (let i = 0; i < row; i++) {
      const a = i >= channels ? pixels[y * row + i - channels] : 0, b = y > 0 ? pixels[(y - 1) * row + i] : 0;
      const c = i >= channels && y > 0 ? pixels[(y - 1) * row + i - channels] : 0;
      const pa = Math.abs(b - c), pb = Math.abs(a - c), pc = Math.abs(a + b - 2 * c);
      const paeth = pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
      pixels[y * row + i] = raw[y * (row + 1) + 1 + i] + [0, a, b, (a + b) >> 1, paeth][filter];
    }
  }
  return { width, height, at: (x, y) => [...pixels.subarray((y * width + x) * channels, (y * width + x) * channels + 3)] };
}

// The number of colors in a part of a picture.
function colorCount(image, { x, y, width, height }) {
  const colors = new Set();
  for (let j = Math.ceil(y); j < Math.floor(y + height); j++)
    for (let i = Math.ceil(x); i < Math.floor(x + width); i++) colors.add(image.at(i, j).join());
  return colors.size;
}

// The part of pixels in which two pictures of one size differ visibly.
function difference(a, b, { x, y, width, height }) {
  let different = 0, all = 0;
  for (let j = Math.ceil(y); j < Math.floor(y + height); j++)
    for (let i = Math.ceil(x); i < Math.floor(x + width); i++) {
      const p = a.at(i, j), q = b.at(i, j);
      all++;
      if (Math.max(...p.map((v, k) => Math.abs(v - q[k]))) > 24) different++;
    }
  return different / all;
}

module.exports = { readPng, colorCount, difference };
