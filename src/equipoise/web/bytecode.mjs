// Starts the runtime in Node: node bytecode.mjs RUNTIME OUT WHEEL...  See bytecode.py.
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

const [runtime, out, ...wheels] = process.argv.slice(2);
const { loadPyodide } = await import(pathToFileURL(join(runtime, "pyodide.mjs")).href);
// Without columns in tracebacks, which are a quarter of bytecode; and the same bytes every time.
const env = { HOME: "/home/pyodide", PYTHONNODEBUGRANGES: "1", PYTHONHASHSEED: "0" };
const python = await loadPyodide({ indexURL: join(runtime, "/"), env });
const extractDir = python.runPython("import sysconfig; sysconfig.get_path('purelib')");
for (const wheel of wheels) python.unpackArchive(new Uint8Array(readFileSync(wheel)), "wheel", { extractDir });
const bytes = python.runPython("from equipoise.web.bytecode import export_bytecode; export_bytecode()").toJs();
writeFileSync(out, bytes);
