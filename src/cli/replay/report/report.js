"use strict";
// Expected and drawn picture of a scene: side by side, in turns, or parted by a line; enlarged without smoothing. Without this script the picture of all three panels stands there.

const GAP = 8;
const MODES = ["Side by side", "Blink", "Swipe", "Difference"];
const still = matchMedia("(prefers-reduced-motion: reduce)").matches;

function made(tag, properties, ...children) {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
}

class Viewer {
  constructor(figure, image) {
    const panels = figure.dataset.panels === "3" ? 3 : 1;
    Object.assign(this, { figure, image, panels, width: (image.naturalWidth - GAP * (panels - 1)) / panels, height: image.naturalHeight });
    Object.assign(this, { mode: panels === 3 ? "Side by side" : "Drawn", zoom: 0, middle: [this.width / 2, this.height / 2], drawn: false, part: 0.5 });
    this.canvas = made("canvas", { tabIndex: 0 });
    this.canvas.setAttribute("role", "application");
    this.canvas.setAttribute("aria-label", `${image.alt}: arrows move it, plus and minus zoom, 0 shows all, space changes between expected and drawn`);
    this.said = made("span", { className: "said" });
    this.said.setAttribute("role", "status");
    this.swipe = made("input", { type: "range", min: 0, max: 1000, value: 500, hidden: true, oninput: () => { this.part = this.swipe.value / 1000; this.paint(); } });
    this.swipe.setAttribute("aria-label", "How much is shown as expected, from the left");
    const button = (text, act, label) => {
      const each = made("button", { type: "button", onclick: act }, text);
      if (label) each.setAttribute("aria-label", label);
      return each;
    };
    this.choices = panels === 3 ? MODES.map((mode) => button(mode, () => this.choose(mode))) : [];
    const first = figure.dataset.first?.split(",").map(Number);
    const zooms = [button("−", () => this.scale(0.5), "Zoom out"), button("+", () => this.scale(2), "Zoom in"), button("All", () => this.all())];
    if (first) zooms.push(button("First difference", () => this.go(first)));
    const bar = (label, parts) => {
      const group = made("span", { className: "group" }, ...parts);
      group.setAttribute("role", "group");
      group.setAttribute("aria-label", label);
      return group;
    };
    this.zooms = made("span", { className: "zoom" });
    const bars = made("div", { className: "bar" }, ...(panels === 3 ? [bar("View", this.choices)] : []), bar("Zoom", [...zooms, this.zooms]));
    figure.classList.add("live");
    figure.append(bars, this.canvas, this.swipe, this.said);
    this.listen();
    new ResizeObserver(() => this.paint()).observe(this.canvas);
    this.choose(this.mode);
  }

  listen() {
    const { canvas } = this;
    // The wheel scrolls the page until the picture is clicked.
    canvas.addEventListener("wheel", (event) => {
      if (document.activeElement !== canvas && !event.ctrlKey) return;
      event.preventDefault();
      this.scale(event.deltaY < 0 ? 1.25 : 0.8, this.place(event));
    }, { passive: false });
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      this.held = { x: event.offsetX, y: event.offsetY, middle: [...this.middle], moved: false };
    });
    canvas.addEventListener("pointermove", (event) => {
      const { held } = this;
      if (!held) return;
      const [dx, dy] = [event.offsetX - held.x, event.offsetY - held.y];
      held.moved ||= Math.hypot(dx, dy) > 4;
      if (!held.moved) return;
      if (this.mode === "Swipe" && this.zoom === 0) {
        this.part = Math.min(1, Math.max(0, event.offsetX / canvas.clientWidth));
        this.swipe.value = this.part * 1000;
      } else {
        this.middle = [held.middle[0] - dx / this.scaled(), held.middle[1] - dy / this.scaled()];
      }
      this.paint();
    });
    canvas.addEventListener("pointerup", () => {
      if (this.held && !this.held.moved && this.mode === "Blink") this.turn();
      this.held = null;
    });
    canvas.addEventListener("keydown", (event) => {
      const move = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
      if (move) this.move(move.map((by) => (by * 40) / this.scaled()));
      else if (event.key === "+" || event.key === "=") this.scale(2);
      else if (event.key === "-") this.scale(0.5);
      else if (event.key === "0") this.all();
      else if (event.key === " " && this.panels === 3) { if (this.mode !== "Blink") this.choose("Blink", false); this.turn(); }
      else return;
      event.preventDefault();
    });
  }

  choose(mode, turning = !still) {
    this.mode = mode;
    this.choices.forEach((each) => each.setAttribute("aria-pressed", each.textContent === mode));
    this.swipe.hidden = mode !== "Swipe";
    this.drawn = false;
    clearInterval(this.timer);
    if (mode === "Blink" && turning) this.timer = setInterval(() => this.turn(true), 700);
    this.paint();
  }

  // Shows the other picture; by hand the turning ends.
  turn(itself = false) {
    if (!itself) clearInterval(this.timer);
    this.drawn = !this.drawn;
    this.paint();
  }

  all() {
    Object.assign(this, { zoom: 0, middle: [this.width / 2, this.height / 2] });
    this.paint();
  }

  go([x, y]) {
    Object.assign(this, { zoom: 16, middle: [x + 0.5, y + 0.5] });
    this.paint();
  }

  move([x, y]) {
    this.middle = [this.middle[0] + x, this.middle[1] + y];
    this.paint();
  }

  // Views that lie beside one another: left edge and width, in pixels of the window.
  views() {
    const count = this.mode === "Side by side" ? 3 : 1;
    const between = count > 1 ? 6 : 0;
    const width = (this.canvas.clientWidth - between * (count - 1)) / count;
    return Array.from({ length: count }, (_, n) => [n * (width + between), width]);
  }

  scaled() {
    const [[, width]] = this.views();
    return this.zoom || Math.min(width / this.width, this.canvas.clientHeight / this.height);
  }

  // Where in the picture the pointer is.
  place(event) {
    const [left, width] = this.views().find(([start, wide]) => event.offsetX < start + wide) ?? this.views()[0];
    const scale = this.scaled();
    return [this.middle[0] + (event.offsetX - left - width / 2) / scale, this.middle[1] + (event.offsetY - this.canvas.clientHeight / 2) / scale];
  }

  // What lies at `held` stays where it is.
  scale(factor, held = this.middle) {
    const before = this.scaled();
    this.zoom = Math.max(0.1, Math.min(64, before * factor));
    this.middle = this.middle.map((at, n) => held[n] + ((at - held[n]) * before) / this.zoom);
    this.paint();
  }

  paint() {
    const { canvas, image } = this;
    const ratio = devicePixelRatio || 1;
    // The height follows from what is shown.
    const [[, viewed]] = this.views();
    canvas.style.height = `${Math.max(96, Math.min(innerHeight * 0.7, (viewed * this.height) / this.width))}px`;
    const [wide, high] = [canvas.clientWidth, canvas.clientHeight];
    if (!wide || !high) return;
    [canvas.width, canvas.height] = [Math.round(wide * ratio), Math.round(high * ratio)];
    const context = canvas.getContext("2d");
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    const scale = this.scaled();
    context.imageSmoothingEnabled = scale < 1;
    const draw = (panel, left, width, from = left, to = left + width) => {
      context.save();
      context.beginPath();
      context.rect(from, 0, to - from, high);
      context.clip();
      const [x, y] = [left + width / 2 - this.middle[0] * scale, high / 2 - this.middle[1] * scale];
      context.drawImage(image, panel * (this.width + GAP), 0, this.width, this.height, x, y, this.width * scale, this.height * scale);
      context.restore();
    };
    const views = this.views();
    if (this.mode === "Side by side") views.forEach(([left, width], panel) => draw(panel, left, width));
    else if (this.mode === "Swipe") {
      const at = Math.round(wide * this.part);
      draw(0, 0, wide, 0, at);
      draw(1, 0, wide, at, wide);
      for (const [color, width] of [["#000", 3], ["#fff", 1]]) {
        context.fillStyle = color;
        context.fillRect(at - width / 2, 0, width, high);
      }
    } else draw({ Blink: this.drawn ? 1 : 0, Difference: 2, Drawn: 0 }[this.mode], 0, wide);
    this.zooms.textContent = scale < 1 ? `${Math.round(scale * 100)} %` : `${+scale.toFixed(1)} ×`;
    this.said.textContent = { "Side by side": `expected, drawn, difference times ${this.figure.dataset.scale}`, Blink: this.drawn ? "drawn" : "expected", Swipe: "left expected, right drawn", Difference: `difference, times ${this.figure.dataset.scale}`, Drawn: "drawn" }[this.mode];
  }
}

for (const figure of document.querySelectorAll("figure[data-panels]")) {
  const image = figure.querySelector("img");
  image.decode().then(() => new Viewer(figure, image), () => {});
}
