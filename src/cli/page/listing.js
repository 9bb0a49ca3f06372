// A draw's program in the combiner language, to be changed, with the values of a pixel beside each line.
import { el, swatch } from "./elements.js";
import { channelsOf } from "./strip.js";

const REGISTERS = { col0: "primary", col1: "secondary", fog: "fog", tex0: "texture0", tex1: "texture1", tex2: "texture2", tex3: "texture3", spare0: "spare0", spare1: "spare1" };

// What each line of a program assigns, with the steps of a fragment.
export function assignmentsOf(text, fragment) {
  const found = [];
  let [line, depth, stage, portion, product] = [0, 0, -1, "", 0];
  for (const [token, portioned, target, channel] of text.matchAll(/\/\/[^\n]*|\n|[{}]|\b(rgb|alpha)\s*\{|\b(out|\w+)(?:\.(\w+))?\s*=/g)) {
    if (token === "\n") line += 1;
    else if (token === "{") { if (depth === 0) stage += 1; depth += 1; }
    else if (token === "}") { depth -= 1; portion = depth > 1 ? portion : ""; }
    else if (portioned) { [portion, product] = [portioned, 0]; depth += 1; line += token.split("\n").length - 1; }
    else if (target === "out") found.push({ line, block: "final combiner", name: "fragment", channels: channel === "a" ? ["a"] : ["r", "g", "b"] });
    else if (target && portion) {
      const name = REGISTERS[target] ?? `stage${stage}.${portion}.${["AB", "CD", "sum"][product]}`;
      found.push({ line, block: `general stage ${stage} ${portion}`, name, channels: portion === "alpha" ? ["a"] : ["r", "g", "b"] });
      product += 1;
    }
  }
  const step = (block, name) => fragment?.steps.findLast((each) => each.block === block && each.name === name);
  return found.map(({ line, block, name, channels }) => ({ line, block, name, found: channels.map((channel) => [channel, step(block, `${name}.${channel}`)]).filter(([, each]) => each) }));
}

// The same of a function of another language, whose variables are named after the steps.
export function variablesOf(text, fragment) {
  const steps = new Map((fragment?.steps ?? []).map((step) => [step.name.replaceAll(".", "_"), step]));
  return text.split("\n").flatMap((code, line) => {
    const step = steps.get(/^\s+(?:const )?\w+ (\w+) = /.exec(code)?.[1]);
    return step ? [{ line, block: step.block, name: step.name, found: [["a", step]] }] : [];
  });
}

// The values that a fragment has for them, as rows of one line each.
function rows(text, fragment, reveal, assignments) {
  const lines = text.split("\n").map(() => []);
  for (const { line, block, name, found } of assignments(text, fragment)) {
    if (!found.length) continue;
    const values = Object.fromEntries(found);
    const color = [values.r, values.g, values.b].map((step) => step?.value);
    const bytes = found[0][1].per_one === 255;
    lines[line].push(el("button", { className: "said", title: `${block}: ${name}`, onclick: () => reveal(block) },
      bytes && color[0] !== undefined ? swatch(color.map((value) => Math.max(0, Math.min(255, value)))) : null,
      channelsOf(values).map(([channel, step]) => el("span", { className: `channel ${channel}` }, String(step.value))), bytes ? null : el("small", {}, ` / ${found[0][1].per_one}`)));
  }
  return lines;
}

export class Listing {
  // `changed` takes a text while somebody types, and returns the findings in it: lines of the program, and messages. `commit` takes it when they are done;
  // without it nobody types.
  constructor({ text, label, fragment, changed, commit, reveal, assignments = assignmentsOf }) {
    Object.assign(this, { fragment, changed, reveal, assignments });
    this.area = el("textarea", { value: text, readOnly: !commit, spellcheck: false, wrap: "off", "aria-label": label, oninput: () => this.typed(), onchange: () => commit(this.area.value) });
    this.beside = el("div", { className: "beside", "aria-label": "Values of the pixel" });
    this.area.addEventListener("mousemove", (event) => this.light(this.lineAt(event)));
    this.area.addEventListener("mouseleave", () => this.light(-1));
    this.element = el("div", { className: "listing" }, this.area, this.beside);
    this.show();
  }

  lineAt(event) {
    return Math.floor((event.offsetY - parseFloat(getComputedStyle(this.area).paddingTop)) / parseFloat(getComputedStyle(this.area).lineHeight));
  }

  light(line) {
    [...this.beside.children].forEach((row, n) => row.classList.toggle("lit", n === line));
  }

  typed() {
    this.changed(this.area.value, (fragment, findings) => {
      this.fragment = fragment;
      this.show(findings);
    });
  }

  show(findings = []) {
    const text = this.area.value;
    this.area.rows = Math.max(4, text.split("\n").length);
    const lines = rows(text, this.fragment, this.reveal, this.assignments);
    for (const { line, message } of findings) lines[Math.max(0, Math.min(lines.length - 1, line))].push(el("span", { className: "wrong" }, `✗ ${message}`));
    this.beside.replaceChildren(...lines.map((line) => el("div", { className: "row" }, line)));
  }
}
