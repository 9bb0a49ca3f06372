// Tests of the package that run in node and in a browser.

function same(found, expected, what = "") {
  const [a, b] = [found, expected].map((value) => JSON.stringify(value));
  if (a !== b) throw new Error(`${what} ${a} is not ${b}`);
}

function fails(work, ...expected) {
  try {
    work();
  } catch (error) {
    for (const text of expected) if (!error.message.includes(text)) throw new Error(`\`${text}\` is not in ${error.message}`);
    return error;
  }
  throw new Error(`nothing says ${expected}`);
}

export function check(ninebit, SceneError, { text, files, expected }) {
  const scene = ninebit.open(text, { files });
  const { width, height, digest, pixels } = scene.render();
  same([width, height, digest, pixels.length], [640, 480, expected, 640 * 480 * 4]);

  const trace = scene.trace(200, 300);
  const step = (name) => trace.draws.at(-1).steps.findLast((step) => step.name === name).value;
  const { planes } = scene.planes(["stage0.rgb.AB.r", "texture0.rgb", "stored.word"]);
  const at = 300 * width + 200;
  same(planes.map((plane) => plane.step), ["stage0.rgb.AB.r", "texture0.r", "texture0.g", "texture0.b", "stored.word"]);
  for (const { step: name, values } of planes) same(values[at], step(name), name);
  same(planes[4].values[at], trace.word);
  const part = scene.planes(["texture0.r"], { rectangle: [200, 300, 3, 2] });
  same([part.width, part.height, part.planes[0].values[0]], [3, 2, step("texture0.r")]);
  same(scene.planeNames()["stage0.rgb.AB.r"].startsWith("general stage 0"), true);

  // Another scene, and the first again.
  const other = ninebit.render("(version: 1, profile: Nv2a, targets: [(width: 4, height: 3)], draws: [])");
  same([other.width, other.height], [4, 3]);
  same(scene.render().digest, expected);
  same(scene.render({ policies: { "CMB-3": "literal" } }).digest === expected, false);
  same(scene.render().digest, expected);

  same(ninebit.check("(version: 1, profil: Nv2a)").scene, null);
  const refused = fails(() => ninebit.open("(version: 1, profil: Nv2a)"), "did you mean `profile`");
  same([refused instanceof SceneError, refused.code], [true, "NB0201"]);
  fails(() => scene.planes(["unit0.wight_u"]), "NB1401", "unit0.weight_u");
  fails(() => scene.render({ target: "none" }), "it has frame");
}
