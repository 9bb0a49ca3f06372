// The picture: zoom, pan, cross hair.
import { $ } from "./elements.js";

// Pixels between two pictures.
const GAP = 8;

export function sheetOf({ width, height, pixels }) {
  const sheet = document.createElement("canvas");
  [sheet.width, sheet.height] = [width, height];
  const image = new ImageData(new Uint8ClampedArray(pixels), width, height);
  for (let at = 3; at < image.data.length; at += 4) image.data[at] = 255;
  sheet.getContext("2d").putImageData(image, 0, 0);
  return sheet;
}

export class View {
  constructor(choose, hover) {
    Object.assign(this, { canvas: $("view"), choose, hover, zoom: 1, left: 0, top: 0, at: null, picture: null, channels: "colour", way: "", part: 0.5 });
    this.sheet = document.createElement("canvas");
    this.other = null;
    const canvas = this.canvas;
    new ResizeObserver(() => this.size()).observe(canvas);
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.scale(event.deltaY < 0 ? 1.25 : 0.8, event.offsetX, event.offsetY);
    }, { passive: false });
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      this.held = { x: event.offsetX, y: event.offsetY, left: this.left, top: this.top, moved: false };
    });
    canvas.addEventListener("pointermove", (event) => {
      const held = this.held;
      if (held) {
        const [dx, dy] = [event.offsetX - held.x, event.offsetY - held.y];
        held.moved ||= Math.hypot(dx, dy) > 4;
        if (held.moved) {
          [this.left, this.top] = [held.left + dx, held.top + dy];
          this.paint();
        }
      }
      if (this.way === "swipe" && !held) {
        this.part = event.offsetX / this.canvas.clientWidth;
        this.paint();
      }
      this.hover(this.pixelAt(event.offsetX, event.offsetY));
    });
    canvas.addEventListener("pointerup", (event) => {
      const pixel = this.pixelAt(event.offsetX, event.offsetY);
      if (this.held && !this.held.moved && pixel) this.choose(pixel);
      this.held = null;
    });
    canvas.addEventListener("pointerleave", () => this.hover(null));
    canvas.addEventListener("keydown", (event) => this.key(event));
  }

  key(event) {
    const moves = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
    const move = moves[event.key];
    const middle = [this.canvas.clientWidth / 2, this.canvas.clientHeight / 2];
    if (move && this.picture) {
      const step = event.shiftKey ? 10 : 1;
      const [x, y] = this.at ?? [0, 0];
      const limit = (value, most) => Math.max(0, Math.min(most - 1, value));
      this.choose([limit(x + move[0] * step, this.picture.width), limit(y + move[1] * step, this.picture.height)]);
      this.reveal();
    } else if (event.key === "+" || event.key === "=") this.scale(1.25, ...middle);
    else if (event.key === "-") this.scale(0.8, ...middle);
    else if (event.key === "0") this.fit();
    else if (event.key === "," || event.key === ".") this.step(event.key === "." ? 1 : -1);
    else return;
    event.preventDefault();
  }

  size() {
    const ratio = window.devicePixelRatio || 1;
    this.canvas.width = Math.max(1, Math.round(this.canvas.clientWidth * ratio));
    this.canvas.height = Math.max(1, Math.round(this.canvas.clientHeight * ratio));
    if (this.fitted) this.fit();
    else this.paint();
  }

  // What the program drew, until the module is there to draw it again. When it was seen.
  async preview(png) {
    if (!png) return null;
    const image = new Image();
    image.src = `data:image/png;base64,${png}`;
    await image.decode();
    if (this.picture) return null;
    const sheet = document.createElement("canvas");
    [sheet.width, sheet.height] = [image.width, image.height];
    const context = sheet.getContext("2d");
    context.drawImage(image, 0, 0);
    this.show({ width: image.width, height: image.height, pixels: context.getImageData(0, 0, image.width, image.height).data });
    return performance.now();
  }

  // A second picture, and the way in which both are shown: beside each other, in turn, or parted where the pointer is.
  beside(picture, way) {
    clearInterval(this.turns);
    this.way = picture ? way : "";
    this.other = picture ? sheetOf(picture) : null;
    this.second = false;
    if (this.way === "blink") {
      this.turns = setInterval(() => {
        this.second = !this.second;
        this.paint();
      }, 500);
    }
  }

  show(picture) {
    const other = !this.picture || this.picture.width !== picture.width || this.picture.height !== picture.height;
    this.picture = picture;
    const { width, height, pixels } = picture;
    if (this.sheet.width !== width || this.sheet.height !== height) [this.sheet.width, this.sheet.height] = [width, height];
    const image = new ImageData(width, height);
    // Of words of depth and stencil: the depth, spread over the greys; the stencil as it is.
    const only = { R: 0, G: 1, B: 2, A: 3, stencil: 3 }[this.channels] ?? -1;
    const spread = picture.low === undefined || this.channels !== "depth" ? null : 255 / (picture.high - picture.low);
    for (let at = 0; at < pixels.length; at += 4) {
      const grey = spread === null ? null : (pixels[at] + pixels[at + 1] * 256 + pixels[at + 2] * 65536 - picture.low) * spread;
      // Of equal depths all are as far as any.
      for (let n = 0; n < 3; n++) image.data[at + n] = Number.isNaN(grey) ? 255 : grey ?? pixels[at + (only < 0 ? n : only)];
      image.data[at + 3] = 255;
    }
    this.sheet.getContext("2d").putImageData(image, 0, 0);
    if (other) this.fit();
    else this.paint();
  }

  fit() {
    if (!this.picture) return;
    const [wide, high] = [this.canvas.clientWidth, this.canvas.clientHeight];
    const both = this.way === "side by side" ? 2 : 1;
    const zoom = Math.min((wide - GAP * (both - 1)) / (this.picture.width * both), high / this.picture.height);
    this.zoom = zoom >= 1 ? Math.floor(zoom) : zoom;
    this.left = (wide - this.picture.width * this.zoom * both - GAP * (both - 1)) / 2;
    this.top = (high - this.picture.height * this.zoom) / 2;
    this.fitted = true;
    this.paint();
  }

  scale(factor, x, y) {
    const zoom = Math.max(0.05, Math.min(96, this.zoom * factor));
    this.left = x - ((x - this.left) * zoom) / this.zoom;
    this.top = y - ((y - this.top) * zoom) / this.zoom;
    this.zoom = zoom;
    this.fitted = false;
    this.paint();
  }

  // Brings the chosen pixel into sight.
  reveal() {
    if (!this.at) return;
    const [wide, high] = [this.canvas.clientWidth, this.canvas.clientHeight];
    const [x, y] = [this.left + (this.at[0] + 0.5) * this.zoom, this.top + (this.at[1] + 0.5) * this.zoom];
    if (x < 0 || x > wide) this.left += wide / 2 - x;
    if (y < 0 || y > high) this.top += high / 2 - y;
    this.paint();
  }

  pixelAt(x, y) {
    if (!this.picture) return null;
    const [i, j] = [Math.floor((x - this.left) / this.zoom), Math.floor((y - this.top) / this.zoom)];
    return i >= 0 && j >= 0 && i < this.picture.width && j < this.picture.height ? [i, j] : null;
  }

  bytes([x, y]) {
    const at = (y * this.picture.width + x) * 4;
    return [...this.picture.pixels.slice(at, at + 4)];
  }

  paint() {
    const context = this.canvas.getContext("2d");
    const ratio = window.devicePixelRatio || 1;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, this.canvas.clientWidth, this.canvas.clientHeight);
    if (!this.picture) return;
    context.imageSmoothingEnabled = this.zoom < 1;
    const [wide, high] = [this.picture.width * this.zoom, this.picture.height * this.zoom];
    context.drawImage(this.way === "blink" && this.second ? this.other : this.sheet, this.left, this.top, wide, high);
    if (this.way === "side by side") context.drawImage(this.other, this.left + wide + GAP, this.top, wide, high);
    if (this.way === "swipe") {
      const edge = Math.max(this.left, Math.min(this.left + wide, this.part * this.canvas.clientWidth));
      context.save();
      context.beginPath();
      context.rect(edge, this.top, this.left + wide - edge, high);
      context.clip();
      context.drawImage(this.other, this.left, this.top, wide, high);
      context.restore();
      context.fillStyle = "#fff";
      context.fillRect(edge - 1, this.top, 2, high);
    }
    if (this.way && this.way !== "side by side") {
      const name = (text, x, align) => {
        context.font = "12px system-ui, sans-serif";
        context.textAlign = align;
        const width = context.measureText(text).width + 10;
        context.fillStyle = "#000b";
        context.fillRect(align === "left" ? x : x - width, this.top + 4, width, 19);
        context.fillStyle = "#fff";
        context.fillText(text, align === "left" ? x + 5 : x - 5, this.top + 18);
      };
      if (this.way === "swipe") {
        name("this", this.left + 4, "left");
        name("the other", this.left + wide - 4, "right");
      } else name(this.second ? "the other" : "this", this.left + 4, "left");
    }
    $("scale").textContent = this.zoom < 1 ? `${Math.round(this.zoom * 100)} %` : `${+this.zoom.toFixed(1)} ×`;
    if (!this.at) return;
    const side = Math.max(this.zoom, 5);
    const x = this.left + (this.at[0] + 0.5) * this.zoom;
    const y = this.top + (this.at[1] + 0.5) * this.zoom;
    // Dark below light: seen on every ground.
    for (const [color, width] of [["#000", 3], ["#fff", 1]]) {
      context.strokeStyle = color;
      context.lineWidth = width;
      context.strokeRect(x - side / 2 - 1, y - side / 2 - 1, side + 2, side + 2);
      context.beginPath();
      const gap = side / 2 + 3;
      for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
        context.moveTo(x + dx * gap, y + dy * gap);
        context.lineTo(x + dx * (gap + 16), y + dy * (gap + 16));
      }
      context.stroke();
    }
  }
}
