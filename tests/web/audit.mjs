// What can be computed of how readable a page is. These functions run in the page: no name from outside is used in them.

// Visible texts whose colour stands out of their ground by less than the AA level of WCAG 2 asks: 4.5, or 3 for large letters. Disabled controls are exempt there.
export function faint() {
  const channels = (color) => {
    const parts = color.match(/[\d.]+/g).map(Number);
    return [parts[0], parts[1], parts[2], parts[3] ?? 1];
  };
  const over = (top, ground) => top.slice(0, 3).map((value, n) => value * top[3] + ground[n] * (1 - top[3]));
  const luminance = (color) => {
    const [r, g, b] = color.map((value) => (value / 255 <= 0.04045 ? value / 255 / 12.92 : ((value / 255 + 0.055) / 1.055) ** 2.4));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  // The ground of an element, and how much of what is drawn on it is seen.
  const known = new Map([[null, [[255, 255, 255], 1]]]);
  const ground = (element) => {
    if (!known.has(element)) {
      const style = getComputedStyle(element);
      const [below, opacity] = ground(element.parentElement);
      known.set(element, [over(channels(style.backgroundColor), below), opacity * Number(style.opacity)]);
    }
    return known.get(element);
  };
  const found = [];
  let count = 0;
  const judge = (element, text, style) => {
    if (element.closest(":disabled") || !element.checkVisibility({ opacityProperty: true, visibilityProperty: true }) || element.closest(".skip, canvas, option")) return;
    const [behind, opacity] = ground(element);
    const ink = channels(style.color);
    ink[3] *= opacity;
    const [light, dark] = [luminance(over(ink, behind)), luminance(behind)].sort((a, b) => b - a);
    const ratio = (light + 0.05) / (dark + 0.05);
    const size = parseFloat(style.fontSize);
    const large = size >= 24 || (size >= 18.66 && Number(style.fontWeight) >= 700);
    count++;
    if (ratio < (large ? 3 : 4.5)) found.push(`${ratio.toFixed(2)}: "${text.slice(0, 40)}" in ${element.tagName}.${element.className}`);
  };
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    const element = node.parentElement;
    if (node.data.trim() && !element.closest("script, style, noscript, template")) judge(element, node.data.trim(), getComputedStyle(element));
  }
  for (const control of document.querySelectorAll("select, input, textarea")) {
    judge(control, control.value, getComputedStyle(control));
    const { fontSize, fontWeight } = getComputedStyle(control);
    if (control.placeholder) judge(control, control.placeholder, { color: getComputedStyle(control, "::placeholder").color, fontSize, fontWeight });
  }
  return { count, found: [...new Set(found)] };
}

// Visible texts and controls that lie on one another.
export function overlapping() {
  const boxes = [];
  const seen = (element) => element.checkVisibility({ opacityProperty: true, visibilityProperty: true }) && !element.closest("script, style, noscript, .skip, option, dialog, #wire");
  const known = new Map();
  // What an element's scrolling ancestors and itself let through.
  const window = (element) => {
    if (!element) return { left: -Infinity, top: -Infinity, right: Infinity, bottom: Infinity };
    if (!known.has(element)) {
      const outer = window(element.parentElement);
      const own = getComputedStyle(element).overflow === "visible" ? outer : clip(element.getBoundingClientRect(), outer);
      known.set(element, own);
    }
    return known.get(element);
  };
  const clip = (a, b) => ({ left: Math.max(a.left, b.left), top: Math.max(a.top, b.top), right: Math.min(a.right, b.right), bottom: Math.min(a.bottom, b.bottom) });
  const add = (owner, element, rectangle, text) => {
    const box = clip(rectangle, window(element));
    if (box.right - box.left > 1 && box.bottom - box.top > 1) boxes.push({ owner, text, ...box });
  };
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    if (!node.data.trim() || !seen(node.parentElement)) continue;
    const range = document.createRange();
    range.selectNodeContents(node);
    for (const rectangle of range.getClientRects()) add(node, node.parentElement, rectangle, node.data.trim());
  }
  for (const control of document.querySelectorAll("select, input, textarea")) if (seen(control)) add(control, control, control.getBoundingClientRect(), control.getAttribute("aria-label") ?? control.tagName);
  boxes.sort((a, b) => a.top - b.top);
  const found = [];
  boxes.forEach((box, n) => {
    for (let m = n + 1; m < boxes.length && boxes[m].top < box.bottom; m++) {
      const other = boxes[m];
      // Lines of small letters are higher than their ink.
      const wide = Math.min(box.right, other.right) - Math.max(box.left, other.left);
      const high = Math.min(box.bottom, other.bottom) - other.top;
      if (other.owner !== box.owner && wide > 2 && high > 4) found.push(`"${box.text.slice(0, 40)}" and "${other.text.slice(0, 40)}" by ${wide.toFixed(0)} x ${high.toFixed(0)}`);
    }
  });
  return { count: boxes.length, found };
}

// What a screen reader is told, of the browser's own tree: controls and landmarks without a name, landmarks that there are not one of.
export function unnamed(nodes) {
  if (!nodes) return { count: 0, landmarks: null, found: [] };
  const told = nodes.filter((node) => !node.ignored);
  const role = (node) => node.role?.value;
  const controls = ["button", "combobox", "textbox", "checkbox", "spinbutton", "tab", "tabpanel", "ColorWell", "application", "link", "radio", "slider", "DisclosureTriangle", "image", "dialog"];
  const landmarks = ["banner", "main", "complementary", "region", "navigation"];
  const found = told.filter((node) => [...controls, ...landmarks.slice(1)].includes(role(node)) && !node.name?.value?.trim()).map((node) => `a ${role(node)} without a name`);
  for (const one of ["banner", "main"]) {
    const count = told.filter((node) => role(node) === one).length;
    if (count !== 1) found.push(`${count} of the landmark ${one}`);
  }
  const regions = told.filter((node) => landmarks.includes(role(node))).map((node) => `${role(node)} ${node.name?.value ?? ""}`);
  return { count: told.filter((node) => controls.includes(role(node))).length, landmarks: regions, found };
}
