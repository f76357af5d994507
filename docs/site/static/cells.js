// Cells of a tutorial, run in this page by the Python of the live page (worker.js of the site around the documentation).
// Their buttons are hidden in a page that is opened as a file: `equipoise site` shows them.

const top_ = document.documentElement.dataset.content_root ?? "./";
const cells = [...document.querySelectorAll(".cell")].map((root) => ({
  code: root.querySelector("pre"),
  button: root.querySelector(".run-cell"),
  outputs: root.querySelector(".cell-outputs"),
  ran: false,
}));
const runnable = cells.filter(({ button }) => button && !button.hidden);
let python = null;
let answered = null;
let turn = Promise.resolve();

function begin() {
  python = new Worker(new URL(`${top_}../worker.js`, location.href), { type: "module", name: "cells" });
  python.onmessage = ({ data }) => {
    if (data.type === "ran") answered?.(JSON.parse(data.outputs));
    else if (data.type === "failed") answered?.([{ kind: "error", content: data.what, topic: "" }]);
  };
  python.onerror = (event) => answered?.([{ kind: "error", content: event.message, topic: "" }]);
}

function element(name, attributes, content = []) {
  const made = Object.assign(document.createElement(name), attributes);
  made.append(...content);
  return made;
}

function shown({ kind, content, topic }) {
  if (kind === "html") return element("div", { className: "cell-html", tabIndex: 0, innerHTML: content });
  const text = element("pre", { className: `cell-${kind}`, tabIndex: 0, textContent: content });
  if (!topic) return text;
  const link = element("a", { href: `${top_}explain/${topic}.html`, textContent: "What to do about it" });
  return element("div", {}, [text, element("p", {}, [link])]);
}

/** Run a cell, in the order in which cells were asked for. */
function run(cell) {
  cell.ran = true;
  cell.button.disabled = true;
  const was = cell.button.textContent;
  cell.button.textContent = python ? "Running …" : "Loading Python …";
  turn = turn.then(async () => {
    if (!python) begin();
    const outputs = await new Promise((done) => {
      answered = done;
      python.postMessage(cell.code.innerText);
    });
    cell.outputs.replaceChildren(...outputs.map(shown));
    cell.button.textContent = was;
    cell.button.disabled = false;
  });
}

for (const [at, cell] of runnable.entries()) {
  Object.assign(cell.code, { contentEditable: "plaintext-only", spellcheck: false });
  for (const [name, value] of [["role", "textbox"], ["aria-multiline", "true"], ["aria-label", `Cell ${at + 1}`]]) cell.code.setAttribute(name, value);
  cell.button.addEventListener("click", () => {
    for (const above of runnable.slice(0, at)) if (!above.ran) run(above); // it may need what they define
    run(cell);
  });
}
