// The search of the site: ranks the sections of search/sections.js by MiniSearch, and shows where in each the words stand.
// Words are split, stemmed and left out as Sphinx's index does it (language_data.js: splitQuery, stopwords, Stemmer).

const ASKING = new Set(["how", "what", "which", "when", "where", "why", "do", "does", "can", "i", "my", "one", "you", "about", "use", "make", "get"]);
const SHOWN = 30;
const LENGTH = 220; // signs of an excerpt
const EAST = /^[\u3005\u3040-\u30ff\u3400-\u9fff\uac00-\ud7af]/u;
// Weights of pages by what they are for: answers first, formulas after what uses them, then lists and records of the project.
const KINDS = [
  [/^(recipes|errors)\//, 2],
  [/^theory/, 0.4],
  [/^(CHANGELOG|SECURITY|CONTRIBUTING|api\/|scripts|conformance|architecture)/, 0.3],
];
const WHOLE = 1.1; // weight of a page, over that of a section of a page that has the same title
const TITLE = 0.5; // by how much a section weighs more whose title has nothing but what is sought
const stemmer = new Stemmer();

const pairs = (run) => (run.length > 1 ? [...run].slice(1).map((sign, at) => run[at] + sign) : [run]);
const words = (text) =>
  (text.toLowerCase().match(/[\u3005\u3040-\u30ff\u3400-\u9fff\uac00-\ud7af]+|[\p{L}\p{N}]+/gu) ?? []).flatMap((run) =>
    EAST.test(run) ? pairs(run) : [run]);
const stem = (word) => (EAST.test(word) ? word : stemmer.stemWord(word));
const processed = (word) => (stopwords.includes(word) || ASKING.has(word) ? null : stem(word));

const index = new MiniSearch({
  fields: ["title", "above", "text"],
  tokenize: words,
  processTerm: processed,
  searchOptions: {
    boost: { title: 4, above: 1.5 },
    prefix: (term) => term.length > 3,
    weights: { prefix: 0.3, fuzzy: 0.1 },
    boostDocument: (id) => {
      const [page, anchor] = SECTIONS[id];
      return (KINDS.find(([pages]) => pages.test(page))?.[1] ?? 1) * (anchor ? 1 : WHOLE);
    },
  },
});
index.addAll(SECTIONS.map(([page, anchor, titles, text], id) => ({ id, title: titles.at(-1), above: titles.slice(0, -1).join(" "), text })));

/** Sections that have what is sought, best first: a title that asks for more words than were typed answers something else. */
function ranked(query, options) {
  const sought = new Set(words(query).map(processed).filter(Boolean));
  const share = ({ id }) => {
    const title = new Set(words(SECTIONS[id][2].at(-1)).map(processed).filter(Boolean));
    return title.size ? [...title].filter((word) => sought.has(word)).length / title.size : 0;
  };
  const weighed = (hit) => ({ ...hit, score: hit.score * (1 + TITLE * share(hit) ** 2) });
  return index.search(query, options).map(weighed).sort((one, other) => other.score - one.score);
}

/** Mark the words that were sought; a text of parts, those at odd places marked. */
function marked(text, stems) {
  const parts = [""];
  for (const piece of text.split(/([\u3005\u3040-\u30ff\u3400-\u9fff\uac00-\ud7af]+|[\p{L}\p{N}]+)/u)) {
    const hit = words(piece).some((word) => stems.has(stem(word)));
    if (hit === (parts.length % 2 === 0)) parts[parts.length - 1] += piece;
    else parts.push(piece);
  }
  return parts;
}

/** The part of a text in which most of the words stand. */
function excerpt(text, stems) {
  const places = [...text.matchAll(/[\u3005\u3040-\u30ff\u3400-\u9fff\uac00-\ud7af]+|[\p{L}\p{N}]+/gu)]
    .filter(([run]) => words(run).some((word) => stems.has(stem(word))))
    .map(({ 0: run, index: at }) => [at, stem(run.toLowerCase())]);
  const count = (at) => new Set(places.filter(([place]) => place >= at && place < at + LENGTH).map(([, word]) => word)).size;
  const best = places.reduce((first, [at]) => (count(at) > count(first) ? at : first), places[0]?.[0] ?? 0);
  const start = best < 60 ? 0 : text.indexOf(" ", best - 50) + 1;
  const end = start + LENGTH < text.length ? text.lastIndexOf(" ", start + LENGTH) : text.length;
  return `${start ? "… " : ""}${text.slice(start, end > start ? end : start + LENGTH)}${end < text.length ? " …" : ""}`;
}

function element(name, content, attributes = {}) {
  const made = Object.assign(document.createElement(name), attributes);
  made.append(...content);
  return made;
}

function show(query) {
  const misspelt = { fuzzy: (term) => (term.length > 4 ? 0.2 : false) };
  const exact = ranked(query);
  const hits = exact.length ? exact : ranked(query, misspelt);
  const stems = new Set(words(query).map(processed).filter(Boolean));
  const highlighted = (text) => marked(text, stems).map((part, at) => (at % 2 ? element("mark", [part]) : part));
  const items = hits.slice(0, SHOWN).map(({ id }) => {
    const [page, anchor, titles, text] = SECTIONS[id];
    const link = element("a", highlighted(titles.at(-1)), { href: `${page}.html${anchor && `#${anchor}`}` });
    const above = titles.slice(0, -1).join(" › ");
    return element("li", [link, ...(above ? [element("small", [above])] : []), element("p", highlighted(excerpt(text, stems)))]);
  });
  const summary = hits.length ? `${hits.length} ${hits.length === 1 ? "section" : "sections"}` : "Nothing was found.";
  document.getElementById("search-results").append(element("p", [summary]), element("ol", items, { className: "search-hits" }));
}

const query = new URLSearchParams(location.search).get("q") ?? "";
for (const box of document.querySelectorAll("input[name=q]")) box.value = query;
if (query.trim()) show(query);
