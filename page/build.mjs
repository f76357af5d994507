// Bundles the page into one script and one style sheet: node build.mjs FOLDER HASH (see bundle.py).
// Beside them are the licenses of all packages that they carry, which stand at the top of the script too.
import { mkdirSync, readdirSync, readFileSync, writeFileSync } from "node:fs";
import { basename, join } from "node:path";
import { build } from "esbuild";

const [folder, hash] = process.argv.slice(2);
const built = await build({
  entryPoints: [
    { in: "src/index.ts", out: "equipoise" },
    { in: "src/style.css", out: "equipoise" },
    { in: "src/interactive/index.ts", out: "interactive" },
    { in: "src/interactive/interactive.css", out: "interactive" },
    { in: "src/site/worker.ts", out: "worker" },
    { in: "src/site/service.ts", out: "service" },
  ],
  outdir: folder,
  bundle: true,
  minify: true,
  format: "esm",
  target: "es2022",
  charset: "utf8",
  legalComments: "none",
  metafile: true,
  write: false,
  logLevel: "warning", // tells errors as well
}).catch(() => process.exit(1));

const about = (name) => JSON.parse(readFileSync(`node_modules/${name}/package.json`, "utf8"));
const inputs = Object.keys(built.metafile.inputs);
const packages = new Set(inputs.flatMap((path) => /node_modules\/((?:@[^/]+\/)?[^/]+)/.exec(path)?.[1] ?? []));
for (const name of packages) {
  // one that is bundled itself carries those that it depends on, and no input tells of them
  for (const inner of Object.keys(about(name).dependencies ?? {})) packages.add(inner);
}

const notices = [...packages].sort().map((name) => {
  const { version, license } = about(name);
  const texts = readdirSync(`node_modules/${name}`).filter((file) => /^(licen[cs]e|notice)/i.test(file));
  if (!texts.length) throw new Error(`${name} has no file with its license`);
  const told = texts.map((file) => readFileSync(`node_modules/${name}/${file}`, "utf8").trim());
  return [`${name} ${version}, license ${license}`, ...told].join("\n\n");
});
const notice = `The live page of Equipoise carries these packages.\n\n${notices.join(`\n\n${"-".repeat(80)}\n\n`)}\n`;

const banners = {
  "equipoise.js": `/* sources ${hash} */\n/* ${notice.replaceAll("*/", "* /")}*/\n`,
  "equipoise.css": "/* Licenses of what it carries are in equipoise.js */\n",
};
mkdirSync(folder, { recursive: true });
writeFileSync(join(folder, "THIRD-PARTY.txt"), notice);
for (const { path, text } of built.outputFiles) writeFileSync(path, (banners[basename(path)] ?? "") + text);
