// What a test asks of a browser, whichever it is.
export class Browser {
  // Starts the one of that name: `chromium` or `firefox`.
  static async start(name = "chromium") {
    const { Chromium } = await import("./chromium.mjs");
    const { Firefox } = await import("./firefox.mjs");
    return name === "firefox" ? Firefox.start() : Chromium.start();
  }

  // Waits for an expression.
  async until(expression, seconds = 60) {
    const end = Date.now() + seconds * 1000;
    while (Date.now() < end) {
      if (await this.value(expression).catch(() => false)) return;
      await new Promise((resolve) => setTimeout(resolve, 20));
    }
    throw new Error(`${expression} did not come true within ${seconds} s`);
  }
}
