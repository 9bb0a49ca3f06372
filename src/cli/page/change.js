// Forms for the values of a scene's text: each changes its place in the text and nothing else.
import { $, choice, colorField, el } from "./elements.js";

const bytes = (text) => {
  const match = /^\(\s*(\d+)\s*,\s*(\d+)\s*,\s*(\d+)\s*(?:,\s*(\d+)\s*)?,?\s*\)$/.exec(text);
  return match && match.slice(1).filter((part) => part !== undefined).map(Number);
};

// A scene may have more fields than somebody would read.
const MOST_FOUND = 100;

const FIRST = { color: "(255, 255, 255)", whole: "0", number: "0" };

export class Change {
  constructor(page) {
    this.page = page;
    this.open = new Set(["scene", "scene/draws", "scene/draws/0"]);
  }

  show(tree) {
    const all = el("div", {}, this.policies(), this.node(tree, "scene"));
    const found = el("div", { role: "status" });
    const seek = () => {
      this.sought = search.value;
      all.hidden = search.value.trim() !== "";
      found.replaceChildren(...(all.hidden ? this.search(tree, search.value.trim().toLowerCase()) : []));
    };
    const search = el("input", { type: "search", value: this.sought ?? "", placeholder: "Search: a field or a value", "aria-label": "Search the scene", oninput: seek });
    $("change").replaceChildren(el("p", { className: "quiet" }, "Each field changes its place in the scene's text. The picture follows while you drag."), search, found, all);
    seek();
  }

  // The fields whose path or value has all words, as fields with their path.
  search(tree, text) {
    const words = text.split(/\s+/);
    const found = [];
    const walk = (node, path) => {
      const name = node.parts?.find((part) => part.label === "name" && part.text)?.text ?? "";
      const here = [...path, `${node.label}${name ? ` ${name}` : ""}`];
      if (node.parts) return node.parts.forEach((part) => walk(part, here));
      const said = `${here.join(" ")} ${node.text ?? ""}`.toLowerCase();
      if (words.every((word) => said.includes(word))) found.push([here, node]);
    };
    walk(tree, []);
    const shown = found.slice(0, MOST_FOUND).map(([path, node]) => el("div", { className: "field" }, el("span", { className: "label" }, path.slice(1).join(" › ")), this.field(node)));
    return [el("p", { className: "quiet" }, found.length > MOST_FOUND ? `${found.length} fields, of which these are the first` : `${found.length} field${found.length === 1 ? "" : "s"}`), ...shown];
  }

  // Opens the groups on the way to a part of the scene, and goes to the last of them that is there.
  reveal(path) {
    path.forEach((_, n) => this.open.add(["scene", ...path.slice(0, n + 1)].join("/")));
  }

  seek(path) {
    const found = path.map((_, n) => ["scene", ...path.slice(0, n + 1)].join("/")).map((place) => [...document.querySelectorAll("#change details")].find((each) => each.dataset.path === place)).filter(Boolean);
    const summary = found.at(-1)?.firstElementChild;
    summary?.scrollIntoView({ block: "center" });
    summary?.focus();
  }

  policies() {
    const { alternatives, policies } = this.page;
    const fields = alternatives.map(({ rule, question, values }) => el("div", { className: "field" }, el("span", { className: "label" }, rule),
      choice(values.map((value) => value.value), policies[rule] ?? values[0].value, question, (value) => this.page.policy(rule, value)), el("span", { className: "quiet" }, question)));
    return this.group("policies", "policies", fields);
  }

  group(label, path, children) {
    const details = el("details", { className: "tree", "data-path": path, open: this.open.has(path) }, el("summary", {}, label));
    const build = () => {
      if (details.childElementCount === 1) details.append(...(typeof children === "function" ? children() : children));
    };
    if (details.open) build();
    details.addEventListener("toggle", () => {
      this.open[details.open ? "add" : "delete"](path);
      if (details.open) build();
    });
    return details;
  }

  node(node, path) {
    if (!node.parts) return el("div", { className: "field" }, el("span", { className: "label" }, node.label), this.field(node));
    const name = node.parts.find((part) => part.label === "name" && part.text)?.text ?? "";
    return this.group(`${node.label} ${name}`, path, () => [
      ...node.parts.map((part) => this.node(part, `${path}/${part.label}`)),
      ...(node.absent?.length ? [this.adder(node)] : []),
    ]);
  }

  adder({ absent, around, span }) {
    const add = (name) => {
      const { kind } = absent.find(({ field }) => field === name);
      this.page.splice(span, `${around[0]}${name}: ${kind.is === "choice" ? kind.words[0] : FIRST[kind.is]}${around[1]}`);
    };
    return el("div", { className: "field" }, choice(["add a field …", ...absent.map(({ field }) => field)], "add a field …", "Add a field", (name) => name !== "add a field …" && add(name)));
  }

  field({ kind, text, span, label }) {
    const set = (value) => this.page.splice(span, value);
    const drag = (value) => this.page.drag(span, value);
    const number = (value, most, change) => el("input", { type: "number", value, min: most === undefined ? undefined : 0, max: most, step: most === undefined ? "any" : 1, "aria-label": label,
      oninput: (event) => event.target.value !== "" && change(event.target.value, drag), onchange: (event) => event.target.value !== "" && change(event.target.value, set) });
    switch (kind.is) {
      case "color": {
        const color = bytes(text);
        if (!color) return this.plain(text, set, label);
        return colorField(color, label, (parts, dragging) => (dragging ? drag : set)(`(${parts.join(", ")})`));
      }
      case "whole":
        return number(text, kind.most, (value, act) => act(value));
      case "number":
        return number(text, undefined, (value, act) => act(value));
      case "numbers": {
        const inside = /^\(([^()]*)\)$/.exec(text)?.[1].split(",").map((part) => part.trim()).filter(Boolean);
        if (!inside || inside.some((part) => Number.isNaN(Number(part)))) return this.plain(text, set, label);
        return el("span", {}, inside.map((part, n) => number(part, undefined, (value, act) => act(`(${inside.map((other, m) => (m === n ? value : other)).join(", ")}${inside.length === 1 ? "," : ""})`))));
      }
      case "choice":
        return choice(kind.words.includes(text) ? kind.words : [text, ...kind.words], text, label, set);
      default:
        return this.plain(text, set, label);
    }
  }

  plain(text, set, label) {
    if (text.length > 60 || text.includes("\n")) return el("code", {}, `${text.slice(0, 57).replaceAll("\n", " ")}…`);
    return el("input", { type: "text", value: text, "aria-label": label, onchange: (event) => set(event.target.value) });
  }
}
