// The strip: one cell for each value that a unit of the chip hands on, in the order of the chip.
import { el, swatch } from "./elements.js";

const COLORS = ["r", "g", "b", "a"];

// The last step of each channel, in the order in which the groups begin. A group is what `key` says of a step's name: its own name and a channel.
function groups(steps, key) {
  const found = new Map();
  for (const step of steps) {
    const [name, channel] = key(step) ?? [];
    if (name === undefined) continue;
    if (!found.has(name)) found.set(name, {});
    found.get(name)[channel] = step;
  }
  return [...found];
}

const named = (pattern) => ({ name }) => pattern.exec(name)?.slice(1);

// The last step of a value, in any channel, among some steps.
const lastOf = (steps, value) => steps.findLast((each) => each.name.startsWith(`${value}.`) && /^[rgba]$/.test(each.name.slice(value.length + 1)));

// What an input reads: a register, 1 minus it, 0 or 1.
function operand(step) {
  const register = (step?.inputs[0]?.name ?? "zero").split(".")[0].replace(/(\d)$/, " $1").replaceAll("_", " ");
  const invert = step?.operation.endsWith("invert");
  return register === "zero" ? (invert ? "1" : "0") : invert ? `(1 − ${register})` : register;
}

const times = (a, b) => (a === "0" || b === "0" ? "0" : a === "1" ? b : b === "1" ? a : `${a} × ${b}`);

// What a register of a combiner was made of, as in `texture 0 · primary`.
function made(step, steps) {
  const [, prefix, output] = /^(.+)\.(AB|CD|sum)\.[rgba]\.output$/.exec(steps[step.inputs[0]?.step]?.name ?? "") ?? [];
  if (!prefix) return "";
  const before = steps.slice(0, step.id + 1);
  const product = (pair) => {
    const [a, b] = [...pair].map((letter) => {
      const read = lastOf(before, `${prefix}.${letter}`);
      return read ? operand(read) : letter;
    });
    if (lastOf(before, `${prefix}.${pair}`)?.operation.startsWith("dot_product")) return `${a} · ${b}`;
    return a === b && !["0", "1"].includes(a) ? `${a}²` : times(a, b);
  };
  if (output !== "sum") return product(output);
  const third = lastOf(before, `${prefix}.sum`);
  const both = ["AB", "CD"].map(product);
  return third?.operation === "select" ? `${both[0]} or ${both[1]}` : both.filter((each) => each !== "0").join(" + ") || "0";
}

// What the final combiner computes: A B + (1 - A) C + D, without what is 0.
function lastFormula(steps) {
  const [a, b, c, d] = ["A", "B", "C", "D"].map((letter) => operand(lastOf(steps, `final.${letter}`)));
  const rest = a === "0" ? "1" : a === "1" ? "0" : `(1 − ${a})`;
  return `${[times(a, b), times(rest, c), d].filter((term) => term !== "0").join(" + ") || "0"} → fragment`;
}

// The cells of a fragment.
export function cellsOf({ steps, stored }) {
  const cells = [];
  const add = (block, title, how, values) => cells.push({ block, title, how, values });
  const of = (test) => steps.filter((step) => test(step.block));
  for (const [name, values] of groups(of((block) => block === "interpolation" || block === "fog"), named(/^(primary|secondary|fog)\.([rgba])$/))) {
    if (name !== "fog") add("interpolation", name, "of three vertices", values);
    else if (values.a?.operation !== "given") add("fog", name, "the factor", { a: values.a });
  }
  for (const [unit, values] of groups(of((block) => block.startsWith("texture unit")), named(/^texture(\d)\.([rgba])$/))) {
    const block = `texture unit ${unit}`;
    const texels = new Map(steps.filter((step) => step.block === block && step.texel).map(({ texel }) => [`${texel.name} ${texel.face} ${texel.level} ${texel.x} ${texel.y}`, texel]));
    const [first] = texels.values();
    add(block, `texture ${unit}`, first ? `${texels.size} texel${texels.size === 1 ? "" : "s"} of ${first.name}` : "", values);
  }
  for (const [name, values] of groups(of((block) => block.startsWith("general stage")).filter((step) => step.operation === "write"), (step) => [`${step.block}/${step.name.split(".")[0]}`, step.name.split(".")[1]])) {
    const [block, register] = name.split("/");
    const [, stage, portion] = /^general stage (\d+) (\w+)$/.exec(block) ?? [];
    const [first] = Object.values(values);
    const of = register.replace(/(\d)$/, " $1");
    const last = cells.at(-1);
    // Colour and alpha of one register, as one stage writes them, are one cell where they are made of the same.
    if (portion === "alpha" && last?.register === register && last.stage === stage) Object.assign(last.values, values);
    else {
      const output = /\.(AB|CD|sum)\.[rgba]\.output$/.exec(first.inputs[0]?.name ?? "")?.[1];
      add(block, `stage ${stage}${output ? `, ${output}` : ""}`, `${made(first, steps)} → ${of}`, { ...values });
      Object.assign(cells.at(-1), { register, stage });
    }
  }
  const fragment = groups(of((block) => block === "final combiner"), named(/^(fragment)\.([rgba])$/))[0];
  if (fragment) add("final combiner", "final combiner", lastFormula(steps), fragment[1]);
  for (const step of steps) {
    const test = /^(alpha|depth|stencil) test$/.exec(step.block) && /pass/.test(step.name) ? step : null;
    if (test) cells.push({ block: step.block, title: step.block, how: step.value ? "passed" : "not passed: dropped", values: {}, passed: Boolean(step.value) });
  }
  const blended = groups(of((block) => block === "blend"), named(/^(blend)\.([rgba])$/))[0];
  if (blended) add("blend", "blend", "with the surface", blended[1]);
  const kept = groups(of((block) => block === "store"), named(/^(stored)\.([rgba])$/))[0];
  if (kept && stored) add("store", "stored", "in the surface", kept[1]);
  return cells;
}

// Whether float64 would have been rounded to another integer.
export const differs = (step) => step.ideal !== null && step.ideal !== undefined && step.per_one > 1 && !step.exponent && Math.abs(step.ideal * step.per_one - step.value) >= 0.5 + 1e-9;

// R, G, B, or one number where they are equal; alpha where there is nothing else.
export function channelsOf(values) {
  const colors = COLORS.slice(0, 3).filter((channel) => values[channel]);
  const equal = colors.length === 3 && new Set(colors.map((channel) => values[channel].value)).size === 1;
  if (equal) return [["", values.r]];
  return (colors.length ? colors : COLORS.filter((channel) => values[channel])).map((channel) => [channel, values[channel]]);
}

// What a cell holds, as a text.
export const told = ({ values, passed }) => (passed === undefined ? channelsOf(values).map(([channel, step]) => `${channel.toUpperCase()} ${step.value}`.trim()).join(" ") : passed ? "passed" : "not passed");

const byte = (step) => Math.max(0, Math.min(255, step?.value ?? 0));

export function strip(fragment, open) {
  const cells = cellsOf(fragment).map((cell) => {
    const wrong = Object.values(cell.values).filter(differs);
    const far = wrong.map((step) => step.ideal * step.per_one - step.value).sort((a, b) => Math.abs(b) - Math.abs(a))[0];
    const off = wrong.length ? `float64 ${far < 0 ? "−" : "+"}${Math.abs(far).toFixed(1)}` : "";
    const { r, g, b } = cell.values;
    const color = r || g || b ? [byte(r), byte(g), byte(b)] : null;
    return el("li", {}, el("button", { className: `cell${cell.passed === false ? " dropped" : ""}`, "data-block": cell.block, onclick: () => open(cell.block),
      title: `${cell.title} ${cell.how}: ${told(cell)}${off && `; ${off}`}` },
      el("span", { className: "title" }, cell.title), el("span", { className: "how" }, cell.how),
      el("span", { className: "value" }, color ? swatch(color) : null, channelsOf(cell.values).map(([channel, step]) => el("span", { className: `channel ${channel}` }, String(step.value))), off ? el("span", { className: "off" }, off) : null),
      el("span", { className: "reading" })));
  });
  return el("ol", { className: "strip", "aria-label": "The pixel's way through the chip" }, cells);
}

// Marks the cells of a strip that would hold something else under another reading of a rule: for each cell its readings.
export function markStrip(list, readings) {
  [...list.querySelectorAll(".cell")].forEach((cell, n) => {
    if (!readings[n]?.length) return;
    const rules = [...new Set(readings[n].map(({ rule }) => rule))];
    const [only] = readings[n];
    cell.querySelector(".reading").textContent = readings[n].length === 1 ? `${only.name}: ${only.there}` : `${rules.slice(0, 3).join(", ")}${rules.length > 3 ? ", …" : ""}`;
    cell.title += readings[n].map(saidOf).map((text) => `\n${text}`).join("");
  });
}

// What a reading would change, in words.
export const saidOf = ({ title, name, meaning, here, there }) => `${title} under ${name} (${meaning}): ${there} instead of ${here}`;
