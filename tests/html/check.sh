#!/usr/bin/env bash
# Opens the HTML report of `ninebit replay` in a real Chromium without a window, and looks at what it made of it.
#
#     tests/html/check.sh [FOLDER]
#
# Debian: `apt-get install chromium python3`. Not part of the test run. Two scenes are replayed, of which one differs by a policy and one has only a digest.
# The page is loaded with the network closed; a script that is added to a copy of it asks the browser for the size of every picture, for what it has loaded, and
# for messages, and for whether the page is wider than the window. FOLDER (default: target/html-check) keeps report, answers and screenshots.
set -euo pipefail
cd "$(dirname "$0")/../.."

out=${1:-target/html-check}
chromium=${CHROMIUM:-$(command -v chromium || command -v chromium-browser || command -v google-chrome)}
rm -rf "$out"
mkdir -p "$out/scenes"
out=$(cd "$out" && pwd)

if [ -z "${NINEBIT:-}" ]; then
    cargo build --release --locked --quiet
    NINEBIT=$PWD/target/release/ninebit
fi
ninebit=$(realpath "$NINEBIT")
cp vectors/scenes/deciding/CMB-3-expand.ron vectors/scenes/dot3/{constant-light.ron,hemisphere.ron} vectors/scenes/dot3/*.png "$out/scenes"
(
    cd "$out"
    unset CI
    "$ninebit" replay --bless scenes
    # What is expected of one scene is what it shows under another value; of the other it is nothing that can be drawn; a third one is broken.
    digest=$("$ninebit" render scenes/constant-light.ron --policy CMB-8=each -o theirs.png --format json | grep -o '[0-9a-f]\{64\}' | head -n 1)
    sed -i "s/sha256: \"[0-9a-f]*\"/sha256: \"$digest\"/" scenes/constant-light.expect.ron
    sed -i 's/sha256: "[0-9a-f]*"/sha256: "'"$(printf '0%.0s' {1..64})"'"/' scenes/hemisphere.expect.ron
    echo '(version: 1, profile: Nv11)' >scenes/broken.ron
    "$ninebit" replay scenes --report html=report.html || [ $? -eq 3 ]
)

# The answers appear in the copy's document, which the browser prints.
python3 - "$out" <<'PYTHON'
import sys
out = sys.argv[1]
page = open(f"{out}/report.html", encoding="utf-8").read()
script = """<script>
const messages = [];
addEventListener("error", event => messages.push(String(event.message || event.target.outerHTML.slice(0, 80))), true);
addEventListener("load", () => {
    const answers = {
        pictures: [...document.images].map(i => [i.naturalWidth, i.naturalHeight, i.clientWidth > 0]),
        loaded: performance.getEntriesByType("resource").map(r => r.name).filter(name => !name.startsWith("data:")),
        changed: document.querySelectorAll("tr.other").length,
        sections: document.querySelectorAll("section").length,
        overflow: document.documentElement.scrollWidth > innerWidth,
        messages,
    };
    const pre = document.createElement("pre");
    pre.id = "answers";
    pre.textContent = JSON.stringify(answers);
    document.body.append(pre);
});
</script>"""
open(f"{out}/asked.html", "w", encoding="utf-8").write(page.replace("<style>", script + "<style>", 1))
PYTHON

# One profile of its own, no sandbox where the user is root, and no way out.
flags=(--headless --disable-gpu --no-sandbox --hide-scrollbars --user-data-dir="$out/profile" --proxy-server=127.0.0.1:9 --proxy-bypass-list='<-loopback>')
timeout 120 "$chromium" "${flags[@]}" --window-size=1280,900 --dump-dom "file://$out/asked.html" >"$out/dom.html" 2>"$out/chromium.log"
timeout 120 "$chromium" "${flags[@]}" --window-size=1280,2600 --screenshot="$out/report.png" "file://$out/report.html" 2>>"$out/chromium.log"
timeout 120 "$chromium" "${flags[@]}" --window-size=500,1600 --screenshot="$out/narrow.png" "file://$out/report.html" 2>>"$out/chromium.log"
rm -rf "$out/profile"

python3 - "$out" <<'PYTHON'
import html, json, re, sys
out = sys.argv[1]
dom = open(f"{out}/dom.html", encoding="utf-8").read()
found = re.search(r'<pre id="answers">(.*?)</pre>', dom, re.S)
assert found, "the page has not been loaded to its end"
answers = json.loads(html.unescape(found.group(1)))
open(f"{out}/answers.json", "w", encoding="utf-8").write(json.dumps(answers, indent=1) + "\n")
print(json.dumps(answers))
expected = {
    "pictures": [[3 * 640 + 16, 480, True], [640, 480, True]],
    "loaded": [], "overflow": False, "messages": [], "sections": 3,
}
wrong = {key: answers[key] for key, value in expected.items() if answers[key] != value}
assert not wrong, wrong
assert answers["changed"] > 0, "no line of the traces is marked"
PYTHON
echo "as expected; look at $out/report.png and $out/narrow.png"
