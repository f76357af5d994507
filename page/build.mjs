// Bundles the page into one script and one style sheet: node build.mjs FOLDER HASH (see bundle.py).
import { readFile } from "node:fs/promises";
import { build } from "esbuild";

const [folder, hash] = process.argv.slice(2);
const license = await readFile("node_modules/uplot/LICENSE", "utf8");

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
    js: `/* sources ${hash} */\n/* Contains uPlot:\n\n${license.trim()}\n*/`,
    css: `/* Contains the style of uPlot; its license is in equipoise.js */`,
  },
  logLevel: "warning", // tells errors as well
}).catch(() => process.exit(1));
