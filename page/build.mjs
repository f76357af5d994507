// Bundles the page into one script and one style sheet: node build.mjs FOLDER HASH (see bundle.py).
import { readFile } from "node:fs/promises";
import { build } from "esbuild";

const [folder, hash] = process.argv.slice(2);
const packages = { uPlot: "uplot/LICENSE", "dxf-parser": "dxf-parser/LICENSE", loglevel: "loglevel/LICENSE-MIT" };
const licenses = await Promise.all(
  Object.entries(packages).map(async ([name, path]) => {
    return `Contains ${name}:\n\n${(await readFile(`node_modules/${path}`, "utf8")).trim()}`;
  }),
);

await build({
  entryPoints: [
    { in: "src/index.ts", out: "equipoise" },
    { in: "src/style.css", out: "equipoise" },
  ],
  outdir: folder,
  bundle: true,
  minify: true,
  format: "esm",
  target: "es2022",
  charset: "utf8",
  legalComments: "none",
  banner: {
    js: `/* sources ${hash} */\n/* ${licenses.join("\n\n")}\n*/`,
    css: `/* Contains the style of uPlot; its license is in equipoise.js */`,
  },
  logLevel: "warning", // tells errors as well
}).catch(() => process.exit(1));
