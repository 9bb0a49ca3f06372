// The page: one scene, its changes, and what is looked at.
import { Address } from "./address.js";
import { Chain } from "./chain.js";
import { Change } from "./change.js";
import { $, bytesOf, denseBytes, el, swatch, through } from "./elements.js";
import { Background, Model, serve } from "./model.js";
import { Program } from "./program.js";
import { Readings } from "./readings.js";
import { View } from "./view.js";

class Page {
  constructor(data, model, background, view) {
    Object.assign(this, { data, model, background, rules: data.rules, alternatives: data.policies, policies: { ...data.chosen }, shortcuts: data.variant ?? "", text: data.text, past: [], future: [], target: 0, until: null, against: "", at: null, times: {} });
    Object.assign(view, { choose: (pixel) => this.choose(pixel), hover: (pixel) => this.hovered(pixel), step: (by) => this.stepDraw(by) });
    this.view = view;
    this.chain = new Chain(this);
    this.change = new Change(this);
    this.listing = new Program(this);
    this.readings = new Readings(this);
    this.address = new Address(this);
    this.programs = new Map();
    for (const [name, bytes] of Object.entries(data.files)) model.file(name, bytesOf(bytes));
    this.wire();
  }

  async begin() {
    this.apply(await this.address.read());
    // A page of a report holds another renderer's picture, and shows the cause of what differs in it.
    const { against } = this.data;
    if (!against) return;
    this.dropped(against.name, bytesOf(against.picture));
    if (this.shortcuts) this.against = "rules";
    this.refresh();
  }

  wire() {
    $("scene-name").textContent = this.data.title ? `${this.data.title} (${this.data.name})` : this.data.name;
    const on = (id, act) => $(id).addEventListener("click", act);
    on("undo", () => this.step(this.past, this.future));
    on("redo", () => this.step(this.future, this.past));
    on("reset", () => this.commit(this.data.text, { ...this.data.chosen }));
    on("save", () => this.save());
    on("link", () => this.address.share());
    on("help", () => $("guide").showModal());
    on("in", () => this.view.scale(1.25, this.view.canvas.clientWidth / 2, this.view.canvas.clientHeight / 2));
    on("out", () => this.view.scale(0.8, this.view.canvas.clientWidth / 2, this.view.canvas.clientHeight / 2));
    on("fit", () => this.view.fit());
    $("variant").addEventListener("change", (event) => { this.shortcuts = event.target.value; this.apply(); });
    $("target").addEventListener("change", (event) => { this.target = +event.target.value; this.until = null; this.at = null; this.refresh(); });
    $("channels").addEventListener("change", (event) => { this.view.channels = event.target.value; this.redraw(); });
    $("against").addEventListener("change", (event) => { this.against = event.target.value; this.redraw(); });
    $("way").addEventListener("change", (event) => { this.way = event.target.value; this.redraw(); this.view.fit(); });
    document.addEventListener("keydown", (event) => {
      if (event.key === "?" && !event.target.matches("textarea, input") && !document.querySelector("dialog[open]")) $("guide").showModal();
      if (!(event.ctrlKey || event.metaKey) || event.key.toLowerCase() !== "z" || event.target.matches("textarea, input")) return;
      event.preventDefault();
      (event.shiftKey ? $("redo") : $("undo")).click();
    });
    const tabs = [...document.querySelectorAll("[role=tab]")];
    for (const tab of tabs) {
      tab.addEventListener("click", () => this.tab(tab.id.slice(4)));
      tab.addEventListener("keydown", (event) => {
        const by = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
        if (by) { const next = tabs[(tabs.indexOf(tab) + by + tabs.length) % tabs.length]; next.focus(); next.click(); }
      });
    }
    const body = document.body;
    body.addEventListener("dragover", (event) => { event.preventDefault(); body.classList.add("drop"); });
    body.addEventListener("dragleave", () => body.classList.remove("drop"));
    body.addEventListener("drop", async (event) => {
      event.preventDefault();
      body.classList.remove("drop");
      const file = event.dataTransfer.files[0];
      if (file) this.dropped(file.name, new Uint8Array(await file.arrayBuffer()));
    });
  }

  say(text) {
    $("message").textContent = text;
  }

  // Does what may be refused, and says why.
  tried(work) {
    try {
      return work();
    } catch (error) {
      this.say(error.message);
      return null;
    }
  }

  tab(name) {
    this.shown = name;
    for (const tab of document.querySelectorAll("[role=tab]")) {
      const chosen = tab.id === `tab-${name}`;
      tab.setAttribute("aria-selected", chosen);
      tab.tabIndex = chosen ? 0 : -1;
      $(tab.id.slice(4)).hidden = !chosen;
    }
    this.panels();
  }

  // --- the scene and its changes

  // Reads the text; a broken one leaves the picture before it, and its findings.
  open(text) {
    const answer = this.tried(() => this.model.ask({ do: "open", text, name: this.data.name }));
    if (!answer) return false;
    const findings = answer.findings.map((finding) => el("div", { className: `finding ${finding.severity}`, tabindex: 0, onclick: () => this.mark(finding) }, finding.rendered.trimEnd()));
    if (answer.suppressed) findings.push(el("p", {}, `and ${answer.suppressed} more`));
    $("findings").replaceChildren(...findings);
    this.findings = answer.findings;
    if (!answer.scene) return false;
    this.scene = answer.scene;
    this.programs.clear();
    return true;
  }

  commit(text, policies = this.policies) {
    if (text === this.text && JSON.stringify(policies) === JSON.stringify(this.policies)) return;
    this.past.push({ text: this.text, policies: this.policies });
    this.future = [];
    Object.assign(this, { text, policies });
    this.apply();
  }

  step(from, to) {
    const state = from.pop();
    if (!state) return;
    to.push({ text: this.text, policies: this.policies });
    Object.assign(this, state);
    this.apply();
  }

  // Shows what stands now, below a message.
  apply(message = "") {
    this.say(message);
    if (!this.tried(() => this.stand())) this.shortcuts = "";
    this.sound = this.open(this.text);
    $("undo").disabled = this.past.length === 0;
    $("redo").disabled = this.future.length === 0;
    $("reset").disabled = this.text === this.data.text && JSON.stringify(this.policies) === JSON.stringify(this.data.chosen);
    if (!this.scene) { this.tab("text"); return; }
    if (this.target >= this.scene.targets.length) this.target = 0;
    this.refresh();
  }

  spliced([start, end], value) {
    return this.text.slice(0, start) + value + this.text.slice(end);
  }

  splice(span, value) {
    cancelAnimationFrame(this.pending);
    this.commit(this.spliced(span, value));
  }

  // While a slider moves: the picture alone follows.
  drag(span, value) {
    this.follow(() => this.spliced(span, value));
  }

  follow(text, then = () => {}) {
    cancelAnimationFrame(this.pending);
    this.readings.stop();
    this.pending = requestAnimationFrame(() => {
      const started = performance.now();
      const changed = text();
      if (changed !== null) {
        if (this.open(changed)) this.redraw(true);
        then(changed);
      }
      this.times.drag = performance.now() - started;
    });
  }

  // A part of a draw's program; while a slider moves the picture alone follows.
  edit(draw, path, value, dragging) {
    const edited = () => {
      const answer = this.tried(() => this.model.ask({ do: "edit", draw, path, value }));
      this.rewritten ||= answer?.rewritten;
      return answer && answer.text;
    };
    if (dragging) return this.follow(edited);
    cancelAnimationFrame(this.pending);
    const text = edited();
    if (text === null) return this.panels();
    this.commit(text);
    if (this.rewritten) this.say(`The program of draw ${draw} was written for an API: from this change on it stands in the combiner language. Undo brings it back.`);
    this.rewritten = false;
  }

  // The form of a part of the scene.
  form(path) {
    this.change.reveal(path);
    this.tab("change");
    this.change.seek(path);
  }

  policy(rule, value) {
    this.commit(this.text, { ...this.policies, [rule]: value });
  }

  save() {
    const link = el("a", { href: URL.createObjectURL(new Blob([this.text], { type: "text/plain" })), download: this.data.name.split("/").pop() });
    link.click();
    URL.revokeObjectURL(link.href);
  }

  // --- what is shown

  refresh() {
    const { targets, draws } = this.scene;
    $("target").replaceChildren(...targets.map((target, n) => el("option", { value: n, selected: n === this.target }, `${target.name} ${target.width} × ${target.height} ${target.format}`)));
    const alternatives = this.readings.others().map(({ name }) => [name, `policy ${name}`]);
    const shown = ["colour", "R", "G", "B", "A", ...(targets[this.target].depth ? ["depth", "stencil"] : [])];
    if (!shown.includes(this.view.channels)) this.view.channels = "colour";
    $("channels").replaceChildren(...shown.map((name) => el("option", { selected: name === this.view.channels }, name)));
    const variants = [...new Set([this.data.variant, this.shortcuts].filter(Boolean))];
    $("variant-part").hidden = variants.length === 0;
    $("variant").replaceChildren(...["", ...variants].map((names) => el("option", { value: names, selected: names === this.shortcuts }, names || "the chip's rules")));
    const options = [["", "nothing"], this.shortcuts ? ["rules", "the chip's rules"] : ["ideal", "float64"], ...(this.past.length ? [["before", "the state before"]] : []), ...(this.second ? [["picture", this.second]] : []), ...alternatives];
    if (!options.some(([value]) => value === this.against)) this.against = "";
    $("against").replaceChildren(...options.map(([value, name]) => el("option", { value, selected: value === this.against }, name)));
    if (this.until !== null && this.until >= draws.length - 1) this.until = null;
    // Of the scene as it came; a change may alter every picture.
    const steps = this.text === this.data.text ? this.data.steps ?? [] : [];
    const item = (draw) => {
      const { picture, marks = [] } = steps[draw.number] ?? {};
      return el("li", {}, el("button", { "aria-current": (this.until ?? draws.length - 1) === draw.number ? "true" : "false", title: "The picture after this draw",
        onclick: () => { this.until = draw.number === draws.length - 1 ? null : draw.number; this.refresh(); } },
        picture && el("img", { src: `data:image/png;base64,${picture}`, alt: "" }),
        el("span", {}, `${draw.number} ${draw.name}`, el("span", { className: "quiet" }, ` → ${targets[draw.target].name}, ${draw.stages} general stage${draw.stages === 1 ? "" : "s"}`),
          marks.map((mark) => el("span", { className: "mark" }, mark)))));
    };
    $("draws").replaceChildren(...draws.map(item));
    this.reveal($("draws"), $("draws").querySelector("[aria-current=true]"));
    const marked = steps.filter((step) => step.marks.length > 0).length;
    $("marked").textContent = marked ? `${marked} of ${draws.length} incomplete` : "";
    this.redraw();
    const { width, height } = targets[this.target];
    if (this.at && (this.at[0] >= width || this.at[1] >= height)) this.at = null;
    this.choose(this.at ?? this.middle(width, height));
  }

  // Scrolls a list, and nothing around it, to one of its parts.
  reveal(list, part) {
    const top = (part?.offsetTop ?? 0) - list.offsetTop;
    if (part && (top < list.scrollTop || top + part.offsetHeight > list.scrollTop + list.clientHeight)) list.scrollTop = top - list.clientHeight / 2;
  }

  // The pixel nearest to the middle, on its row or column, that is not of one colour with the corner, a light one if there is any: most likely something is drawn there.
  middle(width, height) {
    const [x, y] = [Math.floor(width / 2), Math.floor(height / 2)];
    const corner = this.bytesAt([0, 0]).join();
    const drawn = (pixel) => this.bytesAt(pixel).join() !== corner;
    const light = (pixel) => Math.max(...this.bytesAt(pixel).slice(0, 3)) >= 96;
    let dark = null;
    for (let far = 0; far < Math.max(x, y); far++) {
      for (const pixel of [[x - far, y], [x + far, y], [x, y - far], [x, y + far]]) {
        if (pixel[0] >= 0 && pixel[0] < width && pixel[1] >= 0 && pixel[1] < height && drawn(pixel)) {
          if (light(pixel)) return pixel;
          dark ??= pixel;
        }
      }
    }
    return dark ?? [x, y];
  }

  redraw(dragging = false) {
    const started = performance.now();
    const { target, until, against } = this;
    const picture = this.tried(() => this.model.picture({ do: "draw", target, until }));
    if (!picture) return;
    this.picture = picture;
    this.background.drop();
    const memory = ["depth", "stencil"].includes(this.view.channels);
    this.depth = memory ? this.tried(() => this.model.picture({ do: "depth", target, until })) : null;
    $("against").disabled = memory;
    const asked = against && !memory;
    if (asked && against === "before") this.tried(() => this.take(this.before()));
    const other = { before: "picture" }[against] ?? against;
    const request = { do: "heat", target, until, against: against.includes("=") ? this.under(against) : other };
    const heat = asked && against !== "ideal" ? this.tried(() => this.model.picture(request)) : null;
    // Of float64 there is the difference alone.
    const ways = heat ? ["difference", "side by side", "blink", "swipe"] : [];
    if (!ways.includes(this.way)) this.way = "difference";
    $("way-part").hidden = !heat;
    $("way").replaceChildren(...ways.map((way) => el("option", { selected: way === this.way }, way)));
    const beside = heat && this.way !== "difference" ? this.tried(() => this.otherPicture(against)) : null;
    this.differences(heat);
    this.view.beside(beside, this.way);
    this.view.show((beside ? null : heat) ?? this.depth ?? picture);
    if (against === "ideal" && !memory && !dragging) this.later(request);
    if (this.depth) $("legend").replaceChildren(this.view.channels === "depth" ? `depths ${this.depth.low} (black) to ${this.depth.high} (white)` : "stencils 0 (black) to 255 (white)");
    this.times.redraw = performance.now() - started;
    this.times.digest = picture.digest;
  }

  under(policy) {
    const [rule, value] = policy.split("=");
    return { ...this.policies, [rule]: value };
  }

  // Says by what policies and shortcuts the model draws from now on.
  stand(policies = this.policies, shortcuts = this.shortcuts) {
    return this.model.ask({ do: "policies", values: policies, shortcuts });
  }

  // Draws another scene, or this one under other policies, or does other work with it, and brings back what stands.
  elsewhere({ policies = this.policies, shortcuts = this.shortcuts, text = null, name = this.data.name }, work = null) {
    const { target, until } = this;
    try {
      this.stand(policies, shortcuts);
      if (text !== null) {
        const { scene, findings } = this.model.ask({ do: "open", text, name });
        if (!scene) throw new Error(`${name} cannot be drawn: ${findings[0].message}`);
      }
      return work ? work() : this.model.picture({ do: "draw", target, until });
    } finally {
      this.stand();
      if (text !== null) this.model.ask({ do: "open", text: this.text, name: this.data.name });
    }
  }

  before() {
    const { text, policies } = this.past.at(-1) ?? this;
    return this.elsewhere({ policies, text });
  }

  // The picture that is compared with.
  otherPicture(against) {
    if (against.includes("=")) return this.elsewhere({ policies: this.under(against) });
    if (against === "rules") return this.elsewhere({ shortcuts: "" });
    return against === "before" ? this.before() : this.taken;
  }

  // Makes a picture the one that is compared with.
  take({ width, height, pixels }, name = "") {
    this.model.ask({ do: "picture", name, width, height }, new Uint8Array(pixels.buffer, pixels.byteOffset, pixels.byteLength));
  }

  // A comparison that takes seconds. Until it is there the picture stands for itself.
  async later(request) {
    const started = performance.now();
    $("regions-part").hidden = false;
    $("regions-sum").textContent = "Comparing with float64 …";
    $("regions").replaceChildren();
    try {
      const heat = await this.background.picture(this.model, request);
      this.differences(heat);
      this.view.show(heat);
      this.times.heat = performance.now() - started;
    } catch (error) {
      this.differences(null);
      this.say(error.message);
    }
  }

  differences(heat) {
    $("regions-part").hidden = !heat;
    $("legend").replaceChildren(...(heat ? [el("span", {}, "Differences up to, in steps of 1/255:"), ...heat.classes.map(({ label, color }) => el("span", {}, swatch(color), label))] : []));
    if (!heat) return $("regions-sum").replaceChildren();
    const left = heat.diverged ? `; ${heat.diverged} more are left out: a test or a choice differs` : "";
    $("regions-sum").textContent = `${heat.differing} pixels differ${heat.region_count > heat.regions.length ? `; the ${heat.regions.length} largest of ${heat.region_count} regions` : ""}${left}`;
    const item = (region) => el("li", {}, el("button", { onclick: () => { this.choose(region.first); this.view.reveal(); } }, region.worst
      ? `${region.first.join(", ")}: ${["R", "G", "B", "A"][region.worst.channel]} ${region.worst.shown}, ideal ${region.worst.ideal.toFixed(3)}`
      : `${region.x}, ${region.y}: ${region.width} × ${region.height}, ${region.pixels} pixels, by ${region.largest.join(", ")} at most`));
    $("regions").replaceChildren(...heat.regions.map(item));
  }

  // A picture, or another scene with the same files.
  dropped(name, bytes) {
    const scene = () => {
      const drawn = this.elsewhere({ text: new TextDecoder().decode(bytes), name });
      this.take(drawn, name);
      return drawn;
    };
    const picture = this.tried(() => name.endsWith(".ron") ? scene() : this.model.picture({ do: "picture", name }, bytes));
    if (picture) this.taken = picture;
    if (!picture) return;
    this.second = name;
    this.against = "picture";
    this.refresh();
  }

  hovered(pixel) {
    $("hover").textContent = pixel && this.picture ? `${pixel.join(", ")}: ${this.bytesAt(pixel).join(" ")}${this.depthAt(pixel)}` : "";
  }

  bytesAt([x, y], picture = this.picture) {
    const at = (y * picture.width + x) * 4;
    return [...picture.pixels.slice(at, at + 4)];
  }

  depthAt(pixel) {
    if (!this.depth) return "";
    const [low, middle, high, stencil] = this.bytesAt(pixel, this.depth);
    return ` depth ${low + middle * 256 + high * 65536} stencil ${stencil}`;
  }

  stepDraw(by) {
    const last = this.scene.draws.length - 1;
    const to = Math.max(0, Math.min(last, (this.until ?? last) + by));
    this.until = to === last ? null : to;
    this.refresh();
  }

  choose(pixel) {
    this.at = pixel;
    this.view.at = pixel;
    this.view.paint();
    const bytes = this.bytesAt(pixel);
    $("here").replaceChildren(swatch(bytes), `${pixel.join(", ")}: R ${bytes[0]} G ${bytes[1]} B ${bytes[2]} A ${bytes[3]}${this.depthAt(pixel)}`);
    this.panels();
    this.address.write();
  }

  program(draw) {
    if (!this.programs.has(draw)) this.programs.set(draw, this.tried(() => this.model.ask({ do: "program", draw }).program));
    return this.programs.get(draw);
  }

  // Only what is open is brought up to date.
  panels() {
    if (!this.scene && this.shown !== "text") return;
    const { target, until, at: pixel } = this;
    const show = {
      chain: () => {
        const started = performance.now();
        const { trace } = this.model.ask({ do: "trace", target, until, pixel });
        this.times.trace = performance.now() - started;
        this.chain.show(trace, (draw) => this.program(draw));
        this.times.chain = performance.now() - started;
        this.readings.mark(trace);
      },
      rules: () => this.readings.show(this.model.ask({ do: "alternatives", target, until, pixel }).rules),
      change: () => this.sound ? this.change.show(this.model.ask({ do: "outline" }).tree) : $("change").replaceChildren(el("p", {}, "The text has errors: mend it under Scene text, or undo.")),
      program: () => this.listing.show(),
      text: () => this.textPanel(),
    };
    // Who works by keyboard stays where they are when a panel is made anew.
    const panel = $(this.shown ?? "chain");
    const fields = () => [...panel.querySelectorAll("input, select, textarea, button, summary")];
    const at = fields().indexOf(document.activeElement);
    this.tried(show[panel.id]);
    if (at >= 0) fields()[at]?.focus();
  }

  textPanel() {
    const area = el("textarea", { value: this.text, spellcheck: false, "aria-label": "The scene", oninput: () => this.follow(() => area.value), onchange: () => { cancelAnimationFrame(this.pending); this.commit(area.value); } });
    this.area = area;
    $("text").replaceChildren(el("p", { className: "quiet" }, "The scene in RON. The picture follows while you type; what is wrong is said above, with its place."), area);
  }

  mark({ span }) {
    if (!span) return;
    this.tab("text");
    this.area.focus();
    this.area.setSelectionRange(span[0], Math.max(span[1], span[0]));
  }

  rule(id) {
    const rule = this.rules[id];
    if (!rule) return;
    $("rule-title").textContent = `${id} ${rule.title}`;
    const terms = new Map();
    for (const [term, text] of rule.lines) terms.set(term, [...(terms.get(term) ?? []), text]);
    const told = (term, texts) => (term === "Formula" ? el("pre", { tabindex: 0 }, texts.join("\n")) : texts.map((text) => el("p", {}, this.marked(text, id))));
    const parts = [...terms].flatMap(([term, texts]) => [el("h3", {}, texts.length > 1 ? `${term}s` : term), told(term, texts)]);
    $("rule-text").replaceChildren(...parts.flat(2));
    if (!$("rule").open) $("rule").showModal();
    $("rule-text").scrollTop = 0;
  }

  // A text of the handbook: code stands between back-ticks, and other rules lead to their own text.
  marked(text, own) {
    const other = (part) => (part !== own && this.rules[part] ? el("button", { className: "rule", onclick: () => this.rule(part) }, part) : part);
    return text.split("\x60").flatMap((part, n) => (n % 2 ? el("code", {}, part) : part.split(/\b([A-Z]{3}-\d+[a-z]?)\b/).map(other)));
  }
}

async function openPage(script) {
  const started = performance.now();
  try {
    const own = JSON.parse($("data").textContent);
    const view = new View(() => {}, () => {});
    const preview = view.preview(own.picture);
    const [model, common] = await Promise.all([Model.load(denseBytes($("module").textContent)), through(denseBytes($("common").textContent), new DecompressionStream("gzip"))]);
    const data = { ...JSON.parse(new TextDecoder().decode(common)), ...own };
    const page = new Page(data, model, new Background(script), view);
    await page.begin();
    window.inspector = page;
    window.inspector.times.preview = await preview;
    window.inspector.times.first = performance.now() - started;
    window.inspector.times.opened = performance.now();
  } catch (error) {
    $("message").textContent = `This page cannot be shown: ${error.message}`;
  }
}

// The same script is that of the page's second thread, which has no document.
if (typeof document === "undefined") serve();
else openPage(document.currentScript.textContent);
