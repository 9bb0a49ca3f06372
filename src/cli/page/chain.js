// The chain of integers of one pixel: a card for each unit, from the raster to the store.
import { $, choice, colorField, el, hexadecimal, swatch } from "./elements.js";
import { differs, markStrip, saidOf, strip } from "./strip.js";

const CHANNELS = ["r", "g", "b", "a"];

const real = (value, digits = 6) => (value === null || value === undefined ? "" : Number.isInteger(value) && Math.abs(value) > 1e6 ? String(value) : (+value).toPrecision(digits).replace(/\.?0+$/, ""));

const power = (step) => (step.exponent ? ` 2^${step.exponent}` : "");

const integer = (step) => (step.per_one === 0 ? step.value_text ?? hexadecimal(step.value >>> 0, 8) : (step.value_text ?? String(step.value)) + power(step));

// Of a count, a flag or a weight the real number is the integer.
const counts = (step) => step.per_one === 1 && !step.exponent;

function hex(step) {
  if (step.per_one === 0) return integer(step);
  const value = BigInt(step.value_text ?? step.value);
  return (value < 0n ? "-0x" : "0x") + (value < 0n ? -value : value).toString(16).padStart(2, "0") + power(step);
}

const written = (step) => `${step.operation}(${step.inputs.map((input) => `${input.name} ${input.value_text ?? input.value}${power(input)}`).join(", ")})`;

// `stage0.rgb.AB.r.rounded` is the row `AB rounded`, channel r. The r of `unit3.r` is red, but not where it is a coordinate or made of one.
function place({ name }) {
  if (/^unit\d\.(coordinate\.r|quad\d\.r|r\.(rounded|4096|drops)$)/.test(name)) return { row: name, channel: "" };
  const parts = name.split(".");
  const at = parts.findIndex((part, n) => n > 0 && CHANNELS.includes(part));
  if (at < 0) return { row: name, channel: "" };
  return { row: parts.filter((_, n) => n !== at).join("."), channel: parts[at] };
}

const short = (row) => row.replace(/^stage\d+\.(rgb|alpha)\./, "").replace(/^unit\d+\./, "").replace(/^final\./, "");

export class Chain {
  constructor(page) {
    this.page = page;
    this.panel = $("chain");
    this.empty = new Map();
    this.sight = new IntersectionObserver((entries) => this.fill(entries.filter((entry) => entry.isIntersecting).map((entry) => entry.target)), { rootMargin: "500px" });
    this.panel.addEventListener("click", (event) => {
      const wire = event.target.closest(".wire");
      if (wire) this.choose(+wire.dataset.fragment, +wire.dataset.step);
    });
    document.addEventListener("keydown", (event) => {
      if (event.key === "Escape") this.choose(null);
    });
  }

  show(trace, programs) {
    this.trace = trace;
    this.programs = programs;
    this.sight.disconnect();
    this.empty.clear();
    const head = el("div", { className: "head" },
      el("h2", {}, `Pixel ${trace.pixel.join(", ")} of ${trace.target}`),
      el("span", {}, "stored ", swatch(trace.shown), el("code", {}, `R ${trace.shown[0]} G ${trace.shown[1]} B ${trace.shown[2]} A ${trace.shown[3]}`)),
      el("code", { title: "the stored word" }, trace.word_text ?? hexadecimal(trace.word, 8)),
      el("span", { className: "quiet" }, `cleared to ${trace.cleared.join(", ")}`));
    const fragments = trace.draws.map((fragment, n) => this.fragment(fragment, n, n === trace.draws.length - 1));
    const none = trace.draws.length ? [] : [el("p", {}, "No triangle covers this pixel: it shows the clear.")];
    const left = trace.left_out ? [el("p", { className: "quiet" }, `${trace.left_out} earlier fragments are not shown.`)] : [];
    const last = trace.draws.at(-1);
    const way = last ? [el("p", { className: "quiet caption" }, "The way of this pixel through the chip, unit by unit. 255 stands for 1.0, · is a dot product. ",
      el("span", { className: "off" }, "float64 +1.2"), " is how far exact arithmetic would be from the chip's integer; ", el("span", { className: "reading" }, "CMB-8=each: 99"), " is what it would be under another reading of a rule that nothing decides. A click opens the unit."), strip(last, (block) => this.reveal(block))] : [];
    this.panel.replaceChildren(head, ...way, ...none, ...left, ...fragments);
    this.choose(null);
  }

  // Marks what other readings of rules would change: in the strip, and in the units.
  read(readings) {
    const list = this.panel.querySelector(".strip");
    if (!list) return;
    markStrip(list, readings);
    const fragment = [...this.panel.querySelectorAll(".fragment")].at(-1);
    for (const card of fragment.querySelectorAll(".unit")) {
      const said = readings.flat().filter(({ block }) => block === card.getAttribute("aria-label")).map(saidOf);
      if (said.length) card.querySelector(".title").after(el("ul", { className: "readings", "aria-label": "Other readings" }, [...new Set(said)].map((text) => el("li", {}, text))));
    }
  }

  // Goes to a unit of the last fragment.
  reveal(block) {
    const fragment = [...this.panel.querySelectorAll(".fragment")].at(-1);
    if (!fragment) return;
    fragment.open = true;
    const card = [...fragment.querySelectorAll(".unit")].find((each) => each.getAttribute("aria-label") === block);
    if (!card) return;
    const folded = card.closest("details.folded");
    if (folded) folded.open = true;
    this.fill([card]);
    card.scrollIntoView({ block: "start" });
    card.querySelector("button, select, input")?.focus({ preventScroll: true });
  }

  fragment(fragment, number, open) {
    const blocks = [];
    for (const step of fragment.steps) {
      if (blocks.at(-1)?.name !== step.block) blocks.push({ name: step.block, steps: [] });
      blocks.at(-1).steps.push(step);
    }
    const summary = el("summary", {}, `Draw ${fragment.draw} ${fragment.name}, triangle ${fragment.triangle} `,
      el("span", { className: "quiet" }, fragment.stored ? "stored " : "dropped; the surface shows "), swatch(fragment.shown),
      el("span", { className: "quiet" }, fragment.shown.join(", ")));
    const details = el("details", { className: "fragment", open }, summary);
    // What is not looked at is not built.
    const build = () => {
      if (details.childElementCount === 1) details.append(...this.ordered(blocks, fragment, number));
    };
    if (open) build();
    details.addEventListener("toggle", build);
    return details;
  }

  // What a reader looks for comes first: combiners, texture units, tests and store. What carries there is one line until it is opened.
  ordered(blocks, fragment, number) {
    const rank = (name) => (/^general stage \d+$/.test(name) ? 3 : /^(general stage|final)/.test(name) ? 0 : /^texture (unit|shader)/.test(name) ? 1 : /^(rasteriser|interpolation|fog)/.test(name) ? 3 : 2);
    const sorted = blocks.map((block, n) => [rank(block.name), n, block]).sort((a, b) => a[0] - b[0] || a[1] - b[1]);
    return sorted.map(([at, , block]) => {
      const card = this.unit(block, fragment, number);
      if (at !== 3) return card;
      const yields = [...this.rows(block.steps)].filter(([row]) => /^(primary|secondary|fog|E0|E1|E2|W0|W1|W2|constant\d)$/.test(row)).map(([row, cells]) => `${row} ${cells.map(({ step }) => integer(step)).join(" ")}`);
      return el("details", { className: "folded" }, el("summary", {}, el("b", {}, block.name), ` ${yields.join(", ")}`), card);
    });
  }

  unit({ name, steps }, fragment, number) {
    const stage = /^general stage (\d+) (rgb|alpha)$/.exec(name);
    const origin = stage && fragment.program_origin[stage[1]]?.[stage[2]];
    const title = el("h3", {}, name);
    const card = el("section", { className: "unit", "aria-label": name },
      el("div", { className: "title" }, title, this.formOf(name, steps, fragment.draw), origin ? el("span", { className: "origin" }, origin) : null));
    this.empty.set(card, () => {
      if (name.startsWith("texture unit")) card.append(...this.footprints(steps));
      const rows = this.rows(steps);
      card.append(stage ? this.stage(rows, number, fragment.draw, +stage[1], stage[2]) : this.flow(name, rows, number, fragment.draw), this.table(steps, number));
      // Rules of what no box shows stand beside the name.
      const boxed = new Set([...card.querySelectorAll(".box .badge")].map((badge) => badge.dataset.rule));
      title.after(...[...new Set(steps.map((step) => step.rule))].filter((rule) => rule && !boxed.has(rule)).map((rule) => this.badge(rule)));
      card.classList.add("filled");
      this.mark(card);
    });
    this.sight.observe(card);
    return card;
  }

  // The way to the fields of the scene's text that a unit works by.
  formOf(name, steps, draw) {
    const unit = /^texture unit (\d)/.exec(name)?.[1];
    const texture = steps.find((step) => step.texel)?.texel.name;
    const field = { blend: "blend", fog: "fog", "alpha test": "alpha_test", "depth test": "depth_test", "stencil test": "stencil_test", rasteriser: "vertices" }[name];
    const way = (label, path) => el("button", { className: "way", "aria-label": `${label} of ${name}: change`, onclick: () => this.page.form(path) }, label);
    if (unit) return [way("unit", ["draws", String(draw), "textures", unit]), texture ? way("texture", ["textures", texture]) : null];
    return field ? way(field.replaceAll("_", " "), ["draws", String(draw), field]) : null;
  }

  // What a unit holds is made when it comes near the window; of these units, or of all.
  fill(cards = [...this.empty.keys()]) {
    for (const card of cards) {
      const fill = this.empty.get(card);
      this.empty.delete(card);
      this.sight.unobserve(card);
      fill?.();
    }
  }

  badge(rule) {
    const grade = this.page.rules[rule]?.grade ?? "";
    const label = `${rule}${grade ? ` · ${grade}` : ""}`;
    return el("button", { className: `badge ${grade}`, "data-rule": rule, title: this.page.rules[rule]?.title ?? rule, onclick: () => this.page.rule(rule) }, label);
  }

  // Steps by what they are of, one entry a channel.
  rows(steps) {
    const rows = new Map();
    for (const step of steps) {
      const { row, channel } = place(step);
      if (!rows.has(row)) rows.set(row, []);
      rows.get(row).push({ channel, step });
    }
    for (const cells of rows.values()) cells.sort((a, b) => CHANNELS.indexOf(a.channel) - CHANNELS.indexOf(b.channel));
    return rows;
  }

  wire(step, fragment, channel) {
    const more = [hex(step), counts(step) || step.per_one === 0 ? "" : real(step.real), step.ideal === null || step.ideal === undefined ? "" : `float64 ${real(step.ideal)}`].filter(Boolean).join(", ");
    // The real number says something where the integer is none, and the ideal where it would be another integer.
    const beside = step.per_one === 0 && !counts(step) ? real(step.real, 4) : differs(step) ? `float64 ${(step.ideal * step.per_one).toFixed(1)}` : "";
    return el("button", { className: `wire ${channel.length === 1 ? channel : ""}`, title: `${step.name}: ${written(step)}\n${more}`, "data-fragment": fragment, "data-step": step.id },
      channel ? el("i", {}, channel) : null, el("b", {}, integer(step)), beside ? el("small", {}, beside) : null);
  }

  // One for each channel, or one for R, G and B where they say the same.
  wires(cells, fragment) {
    const said = ({ step }) => `${integer(step)} ${differs(step) ? real(step.ideal) : ""}`;
    const colors = cells.filter(({ channel }) => ["r", "g", "b"].includes(channel));
    const equal = colors.length === 3 && new Set(colors.map(said)).size === 1;
    const shown = equal ? [{ channel: "rgb", step: colors[0].step }, ...cells.filter((cell) => !colors.includes(cell))] : cells;
    return el("div", { className: "wires" }, shown.map(({ channel, step }) => this.wire(step, fragment, channel)));
  }

  box(row, cells, fragment, extra) {
    const { step } = cells[0];
    const inputs = [...new Set(step.inputs.map((input) => short(place(input).row)))];
    const from = inputs.length > 4 ? `${inputs.slice(0, 3).join(", ")}, …` : inputs.join(", ");
    const how = step.operation === "given" ? "" : `${step.operation.replaceAll("_", " ")}${from ? ` of ${from}` : ""}`;
    const rules = [...new Set(cells.map(({ step: each }) => each.rule).filter(Boolean))];
    // A single value stands beside its name.
    return el("div", { className: cells.length === 1 && !extra ? "box single" : "box" }, el("span", { className: "name" }, short(row)), el("span", { className: "how" }, how), rules.map((rule) => this.badge(rule)), extra ?? null,
      this.wires(cells, fragment));
  }

  // A general stage as the vendor draws it: inputs, products, sum, outputs.
  stage(rows, fragment, draw, number, portion) {
    const program = this.programs(draw);
    const state = program?.stages[number]?.[portion];
    const path = ["stages", number, portion];
    const editable = Boolean(state);
    const pick = (name, kind, at) => editable
      ? choice(program.choices[kind], at.reduce((value, key) => value[key], state), `${name} of stage ${number} ${portion}`,
        (value) => this.page.edit(draw, [...path, ...at], value))
      : null;
    const columns = { inputs: [], products: [], outputs: [] };
    for (const [row, cells] of rows) {
      const name = short(row);
      const letter = ["A", "B", "C", "D"].indexOf(name);
      const extra = letter < 0 ? null : el("span", {}, pick("Mapping", "mapping", ["inputs", letter, "mapping"]), pick("Register", "register", ["inputs", letter, "register"]), pick("Component", "component", ["inputs", letter, "component"]));
      const column = letter >= 0 ? "inputs" : /^(AB|CD|sum|mux)/.test(name) && !/output|\./.test(name) ? "products" : "outputs";
      columns[column].push([name, this.box(row, cells, fragment, extra)]);
    }
    const boxes = (column, test = () => true) => columns[column].filter(([name]) => test(name)).map(([, box]) => box);
    const pairs = [["A", "B"], ["C", "D"]].map((pair) => boxes("inputs", (name) => pair.includes(name))).filter((pair) => pair.length);
    const flag = (label, field) => el("label", {}, el("input", { type: "checkbox", "aria-label": `${label} of stage ${number} ${portion}`, checked: state[field],
      onchange: (event) => this.page.edit(draw, [...path, field], event.target.checked) }), ` ${label}`);
    const output = (label, field) => [el("span", { className: "quiet" }, `${label} → `), pick(`Output of ${label}`, "destination", [field])];
    const settings = el("div", { className: "field" },
      editable ? [el("span", { className: "quiet" }, "scale "), pick("Scale", "scale", ["scale"]), el("span", { className: "quiet" }, " bias "), pick("Bias", "bias", ["bias"]),
        output("AB", "ab_output"), output("CD", "cd_output"), output(state.mux ? "mux" : "sum", "sum_output"),
        portion === "rgb" ? ["ab", "cd"].map((pair) => [flag(`${pair.toUpperCase()} dot`, `${pair}_dot_product`), flag(`${pair.toUpperCase()} blue to alpha`, `${pair}_blue_to_alpha`)]) : null,
        flag("mux", "mux"), this.constants(program.stages[number].constants, draw, ["stages", number, "constants"], `stage ${number} ${portion}`)] : null);
    return el("div", {}, settings, el("div", { className: "flow" },
      el("div", { className: "stack" }, pairs.map((pair) => el("div", { className: "pair" }, pair))),
      el("div", { className: "stack" }, boxes("products")), el("div", { className: "stack" }, boxes("outputs"))));
  }

  // Any other unit: what it takes from elsewhere, what it computes, what it hands on.
  flow(name, rows, fragment, draw) {
    // Set-up and texels have their table and their footprint.
    const hidden = name.startsWith("texture unit") ? /texel|row\d|\.[GN]_|quad|block/ : /^$/;
    const shown = [...rows].filter(([row]) => !hidden.test(row));
    // How many boxes a value is away from what the unit is given: columns are read from left to right.
    const depths = new Map();
    const made = new Map([...rows].flatMap(([row, cells]) => cells.map(({ step }) => [step.id, row])));
    for (const [row, cells] of rows) {
      const from = cells.flatMap(({ step }) => step.inputs.map((input) => made.get(input.step))).filter((each) => each && each !== row && depths.has(each));
      depths.set(row, from.length ? Math.max(...from.map((each) => depths.get(each) + (hidden.test(each) ? 0 : 1))) : 0);
    }
    const columns = new Map();
    for (const [row, cells] of shown) {
      const at = Math.min(depths.get(row), 3);
      if (!columns.has(at)) columns.set(at, []);
      columns.get(at).push(this.box(row, cells, fragment, name.startsWith("final") ? this.finalPick(row, draw) : null));
    }
    const sorted = [...columns].sort(([a], [b]) => a - b).map(([, boxes]) => el("div", { className: "stack" }, boxes));
    // The inputs A to G stand in their order, whatever was computed first.
    for (const stack of sorted) {
      const letter = (box) => box.querySelector(".name").textContent;
      const inputs = [...stack.children].filter((box) => /^[A-G]$/.test(letter(box))).sort((a, b) => letter(a).localeCompare(letter(b)));
      stack.prepend(...inputs);
    }
    const flow = el("div", { className: "flow" }, sorted);
    flow.style.gridTemplateColumns = `repeat(${Math.max(sorted.length, 2)}, minmax(0, 1fr))`;
    return name.startsWith("final") ? el("div", {}, this.finalSettings(draw), flow) : flow;
  }

  // Constant colours that this unit reads. Of NV10 all units read the same.
  constants(colors, draw, own, of) {
    const path = this.page.scene.profile === "Nv10" ? ["constants"] : own;
    return el("details", { className: "constants" }, el("summary", {}, "constants"), colors.map((color, n) => el("div", { className: "field" }, el("span", { className: "quiet" }, String(n)),
      colorField(color, `Constant ${n} of ${of}`, (value, dragging) => this.page.edit(draw, [...path, n], value, dragging)))));
  }

  // The final combiner's switches.
  finalSettings(draw) {
    const program = this.programs(draw);
    if (!program) return null;
    const flag = (label, field) => el("label", {}, el("input", { type: "checkbox", checked: program.final[field], onchange: (event) => this.page.edit(draw, ["final", field], event.target.checked) }), ` ${label}`);
    return el("div", { className: "field" }, flag("clamp the colour sum", "color_sum_clamp"), flag("1 − SPARE0", "invert_spare0"), flag("1 − SECONDARY", "invert_secondary"),
      this.constants(program.final.constants, draw, ["final", "constants"], "the final combiner"));
  }

  finalPick(row, draw) {
    const at = ["A", "B", "C", "D", "E", "F", "G"].indexOf(short(row));
    const program = this.programs(draw);
    if (at < 0 || !program) return null;
    const input = program.final.inputs[at];
    return el("span", {}, choice(program.choices.final_register, input.register, `Register ${short(row)} of the final combiner`, (value) => this.page.edit(draw, ["final", "inputs", at, "register"], value)),
      choice(program.choices.component, input.component, `Component ${short(row)}`, (value) => this.page.edit(draw, ["final", "inputs", at, "component"], value)),
      el("label", {}, el("input", { type: "checkbox", checked: input.invert, onchange: (event) => this.page.edit(draw, ["final", "inputs", at, "invert"], event.target.checked) }), " 1 − x"));
  }

  // The texels of each fetch as colours with their weights.
  footprints(steps) {
    const found = new Map();
    const value = (name) => steps.find((step) => step.name === name);
    for (const step of steps) {
      const match = /^(unit\d\.(?:next\.)?)texel(\d\d)?\.([rgba])$/.exec(step.name);
      if (!match) continue;
      const [, prefix, at = "", channel] = match;
      if (!found.has(prefix)) found.set(prefix, new Map());
      const texels = found.get(prefix);
      if (!texels.has(at)) texels.set(at, {});
      texels.get(at)[channel] = step;
    }
    return [...found].map(([prefix, texels]) => {
      const [u, v] = ["weight_u", "weight_v"].map((name) => value(prefix + name)?.value ?? 0);
      const linear = texels.size > 1;
      const weight = (at) => (linear ? (at[0] === "1" ? u : 256 - u) * (at[1] === "1" ? v : 256 - v) : 65536) / 65536;
      const where = steps.find((step) => step.texel && step.name.startsWith(prefix))?.texel;
      const cells = [...texels].map(([at, channels]) => {
        const rgb = ["r", "g", "b"].map((c) => Math.max(0, Math.min(255, channels[c]?.value ?? 0)));
        const fetch = steps.find((step) => step.texel && step.name.startsWith(`${prefix}texel${at}.`))?.texel;
        // Where black stands out more than white does.
        const linear8 = (byte) => (byte <= 10 ? byte / 3294.6 : ((byte / 255 + 0.055) / 1.055) ** 2.4);
        const light = 0.2126 * linear8(rgb[0]) + 0.7152 * linear8(rgb[1]) + 0.0722 * linear8(rgb[2]) > 0.179;
        const cell = el("div", { className: `texel ${light ? "light" : "dark"}` },
          el("span", {}, fetch ? `(${fetch.x}, ${fetch.y})` : "border"), el("span", {}, value(`${prefix}texel${at}.word`)?.note ?? ""), el("span", {}, `${(weight(at) * 100).toFixed(1)} %`));
        cell.style.backgroundColor = `rgb(${rgb.join(",")})`;
        if (linear) [cell.style.gridColumn, cell.style.gridRow] = [at[0] === "1" ? 2 : 1, at[1] === "1" ? 2 : 1];
        return cell;
      });
      const result = ["r", "g", "b"].map((c) => Math.max(0, Math.min(255, value(`${prefix}${c}`)?.value ?? value(`${prefix}texel.${c}`)?.value ?? 0)));
      const faces = ["+X", "−X", "+Y", "−Y", "+Z", "−Z"];
      return el("div", { className: "footprint" }, el("div", { className: "texels", role: "img", "aria-label": "texels and weights" }, cells),
        el("div", {}, where ? el("div", {}, el("b", {}, where.name), ` level ${where.level}`, prefixFace(steps) ? `, face ${faces[where.face]}` : "") : null,
          linear ? el("div", { className: "quiet" }, `weights ${u}/256 and ${v}/256`) : el("div", { className: "quiet" }, "nearest texel"),
          el("div", {}, swatch(result), linear ? "filtered" : "fetched")));
    });
    function prefixFace(all) {
      return all.some((step) => step.name.endsWith(".face"));
    }
  }

  table(steps, fragment) {
    const details = el("details", { className: "all" }, el("summary", {}, `all ${steps.length} steps`));
    details.addEventListener("toggle", () => {
      if (details.childElementCount > 1) return;
      const row = (step) => el("tr", {}, el("td", {}, el("button", { className: "wire", "data-fragment": fragment, "data-step": step.id }, step.name)),
        el("td", {}, step.operation === "given" ? "" : written(step)), el("td", { className: "n" }, integer(step)), el("td", { className: "n" }, hex(step)),
        el("td", { className: "n" }, counts(step) ? "" : real(step.real)), el("td", { className: "n" }, real(step.ideal)), el("td", {}, step.rule), el("td", {}, step.note ?? ""));
      const head = ["what", "how", "integer", "hex", "real", "ideal", "rule", "note"].map((title) => el("th", { scope: "col" }, title));
      details.append(el("div", { className: "steps", tabindex: 0, role: "region", "aria-label": "steps" }, el("table", {}, el("thead", {}, el("tr", {}, head)), el("tbody", {}, steps.map(row)))));
      this.mark(details);
    });
    return details;
  }

  mark(part) {
    if (!this.slice && part !== this.panel) return;
    for (const wire of part.querySelectorAll(".wire")) {
      const [fragment, step] = [+wire.dataset.fragment, +wire.dataset.step];
      const here = this.slice?.fragment === fragment;
      wire.classList.toggle("bright", here && this.slice.bright.has(step));
      wire.classList.toggle("chosen", here && this.slice.id === step);
    }
  }

  // What a value depends on stays bright; below, all that is known of it.
  choose(fragment, id) {
    const bar = $("wire");
    this.slice = null;
    this.mark(this.panel);
    this.panel.classList.toggle("slice", fragment !== null);
    bar.hidden = fragment === null;
    if (fragment === null) return;
    const steps = this.trace.draws[fragment].steps;
    const bright = new Set();
    const open = [id];
    while (open.length) {
      const at = open.pop();
      if (bright.has(at)) continue;
      bright.add(at);
      open.push(...steps[at].inputs.map((input) => input.step).filter((step) => step !== undefined));
    }
    this.slice = { fragment, bright, id };
    this.mark(this.panel);
    const step = steps[id];
    const entry = (title, value) => (value === "" ? null : el("div", {}, el("dt", {}, title), el("dd", {}, value)));
    bar.replaceChildren(el("b", {}, step.name), el("dl", {}, entry("integer", integer(step)), entry("hex", hex(step)), entry("of", step.per_one > 1 ? String(step.per_one) : ""),
      entry("real", counts(step) ? "" : real(step.real)), entry("ideal", real(step.ideal)), entry("depends on", bright.size === 2 ? "1 value" : `${bright.size - 1} values`)),
      ...(step.rule ? [this.badge(step.rule)] : []), ...(step.note ? [el("span", { className: "quiet" }, step.note)] : []),
      el("button", { onclick: () => this.choose(null), "aria-label": "Close" }, "×"), el("div", { className: "formula" }, step.operation === "given" ? "" : written(step)));
  }
}
