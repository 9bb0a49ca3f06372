// The address of the page: pixel, target, policies, shortcuts, and where the text differs from the one that was opened.
import { $, base64Of, bytesOf, through } from "./elements.js";

const addressOf = (bytes) => base64Of(bytes).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
const fromAddress = (text) => bytesOf(text.replaceAll("-", "+").replaceAll("_", "/"));

// A state as an address has it. A long one is compressed, and begins with a letter that no other does.
const LONG_STATE = 2000;
async function encoded(value) {
  const bytes = new TextEncoder().encode(JSON.stringify(value));
  return bytes.length < LONG_STATE ? addressOf(bytes) : `z${addressOf(await through(bytes, new CompressionStream("deflate-raw")))}`;
}
async function decoded(text) {
  const bytes = text.startsWith("z") ? await through(fromAddress(text.slice(1)), new DecompressionStream("deflate-raw")) : fromAddress(text);
  return JSON.parse(new TextDecoder().decode(bytes));
}

// Browsers open no address that is much longer.
const LONGEST_ADDRESS = 1_000_000;

export class Address {
  constructor(page) {
    this.page = page;
    this.text = "";
    window.addEventListener("hashchange", async () => { if (location.hash.slice(1) !== this.text) page.apply(await this.read()); });
  }

  async write() {
    const { page } = this;
    const [was, is] = [page.data.text, page.text];
    let start = 0;
    while (start < Math.min(was.length, is.length) && was[start] === is[start]) start++;
    let end = 0;
    while (end < Math.min(was.length, is.length) - start && was[was.length - 1 - end] === is[is.length - 1 - end]) end++;
    const state = {};
    if (page.at) state.p = page.at;
    if (page.target) state.t = page.target;
    if (page.until !== null) state.u = page.until;
    if (was !== is) state.e = [start, was.length - end, is.slice(start, is.length - end)];
    const policies = Object.fromEntries(Object.entries(page.policies).filter(([rule, value]) => page.data.chosen[rule] !== value));
    if (Object.keys(policies).length) state.v = policies;
    if (page.shortcuts !== (page.data.variant ?? "")) state.s = page.shortcuts;
    const turn = (this.turn = (this.turn ?? 0) + 1);
    const address = Object.keys(state).length ? await encoded(state) : "";
    // What was asked for since is later.
    if (turn !== this.turn) return;
    this.fits = address.length <= LONGEST_ADDRESS;
    this.text = this.fits ? address : "";
    history.replaceState(null, "", `#${this.text}`);
  }

  // Takes what the address holds. Returns what is to be said of it.
  async read() {
    const { page } = this;
    this.text = location.hash.slice(1);
    if (!this.text || this.text === "pixel") return "";
    try {
      const { p, t = 0, u = null, e, v = {}, s } = await decoded(this.text);
      const whole = (value) => Number.isInteger(value) && value >= 0;
      if (Array.isArray(p) && p.length === 2 && p.every(whole)) page.at = p;
      page.target = whole(t) ? t : 0;
      page.until = whole(u) ? u : null;
      if (Array.isArray(e) && whole(e[0]) && whole(e[1]) && typeof e[2] === "string") page.text = page.data.text.slice(0, e[0]) + e[2] + page.data.text.slice(e[1]);
      page.policies = { ...page.data.chosen, ...v };
      page.shortcuts = typeof s === "string" ? s : (page.data.variant ?? "");
      return "";
    } catch {
      return "The address is not one of this page; the scene is as it was saved.";
    }
  }

  async share() {
    await this.write();
    if (!this.fits) return this.page.say("The changes are too long for a link. Save RON keeps them.");
    try {
      await navigator.clipboard.writeText(location.href);
      this.page.say("The link is on the clipboard: this pixel, these changes.");
    } catch {
      this.page.say("The address bar has the link: this pixel, these changes.");
    }
  }
}
