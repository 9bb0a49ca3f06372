// Elements. Texts become text nodes, whatever is in them.

export const $ = (id) => document.getElementById(id);

export function el(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (value === undefined || value === null || value === false) continue;
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (name in element && name !== "list") element[name] = value;
    else element.setAttribute(name, value);
  }
  element.append(...children.flat(Infinity).filter((child) => child !== null && child !== undefined));
  return element;
}

export function swatch([r, g, b]) {
  const element = el("span", { className: "swatch" });
  element.style.backgroundColor = `rgb(${r},${g},${b})`;
  return element;
}

// One of some words. There are many of these and few are opened: the other words come when one is.
export function choice(words, chosen, label, change) {
  const select = el("select", { "aria-label": label, title: label, onchange: (event) => change(event.target.value) }, el("option", { value: chosen }, chosen));
  const fill = () => {
    if (select.options.length > 1) return;
    const at = words.indexOf(chosen);
    const option = (word) => el("option", { value: word }, word);
    select.prepend(...words.slice(0, Math.max(at, 0)).map(option));
    select.append(...words.slice(at + 1).map(option));
  };
  for (const type of ["pointerdown", "focus", "keydown"]) select.addEventListener(type, fill);
  return select;
}

const toHex = (rgb) => `#${rgb.slice(0, 3).map((byte) => Math.min(255, byte).toString(16).padStart(2, "0")).join("")}`;

// A colour of three or four bytes: `change` takes it, and whether it still moves.
export function colorField(color, label, change) {
  const parsed = (value) => [1, 3, 5].map((at) => parseInt(value.slice(at, at + 2), 16));
  const on = (read) => ({ oninput: (event) => event.target.value !== "" && change(read(event.target.value), true), onchange: (event) => event.target.value !== "" && change(read(event.target.value), false) });
  return el("span", {}, el("input", { type: "color", value: toHex(color), "aria-label": `${label}, colour`, ...on((value) => [...parsed(value), ...color.slice(3)]) }), " ",
    color.map((byte, n) => el("input", { type: "number", value: byte, min: 0, max: 255, step: 1, "aria-label": `${label} ${"RGBA"[n]}`, ...on((value) => color.map((other, m) => (m === n ? +value : other))) })));
}

export function bytesOf(base64) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let at = 0; at < text.length; at++) bytes[at] = text.charCodeAt(at);
  return bytes;
}

// Bytes of digits of base 85, as `dense` of page.rs writes them.
export function denseBytes(text) {
  const digits = Uint8Array.from({ length: 128 }, (_, code) => ({ 33: 60, 35: 92, 36: 123 })[code] ?? code).map((code) => code - 40);
  const bytes = new Uint8Array(Math.floor((text.length * 4) / 5));
  for (let at = 0, to = 0; at < text.length; at += 5) {
    let word = 0;
    for (let n = 0; n < 5; n++) word = word * 85 + (at + n < text.length ? digits[text.charCodeAt(at + n)] : 84);
    for (let shift = 24; shift >= 0 && to < bytes.length; shift -= 8) bytes[to++] = word >>> shift;
  }
  return bytes;
}

// Characters of bytes, in parts: arguments stand on the stack.
export function base64Of(bytes) {
  let text = "";
  for (let at = 0; at < bytes.length; at += 0x4000) text += String.fromCharCode(...bytes.subarray(at, at + 0x4000));
  return btoa(text);
}

// Bytes as a stream compresses or inflates them.
export const through = async (bytes, stream) => new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(stream)).arrayBuffer());

export const hexadecimal = (value, width = 2) => (value < 0 ? "-0x" : "0x") + Math.abs(value).toString(16).padStart(width, "0");
