/**
 * A worker that computes with Python in WebAssembly, for a page without a server.
 *
 * The first one answers the page.  It starts another of the same script, which computes what takes
 * long; see `equipoise/web/worker.py` for what each of them does.  A page of the documentation starts
 * one that is called `cells`, which runs the cells of a tutorial (`equipoise/web/cells.py`).
 */

/** Content of `site.json`: where the runtime is, and what Python packages there are. */
interface Site {
  runtime: string;
  /** Wheels of this package and of pure Python. */
  own: string[];
  /** Files that lie there compressed, by their paths without the ending. */
  packed: string[];
  /** Packages of the runtime that are needed from the beginning. */
  first: string[];
  /** Names, hashes and files of packages: of those that are part of the site by their path in it. */
  lock: { packages: Record<string, Package> };
}
interface Package {
  file_name: string;
  imports: string[];
}

interface Bytes {
  toJs(): Uint8Array;
  destroy(): void;
}
interface Pair {
  get(index: 0): string;
  get(index: 1): Bytes;
  destroy(): void;
}
interface Foreground {
  take(text: string): void;
  step(): Bytes | undefined;
  missing: string | undefined;
  lacks(name: string): void;
  /** Whether there is a reply at once. */
  rest(): boolean;
  tasks: { length: number; popleft(): Bytes };
  wants_reply(): boolean;
  result_of_task(data: unknown): void;
  cancel(): void;
}
interface Background {
  begin(data: unknown): void;
  step(): Pair | undefined;
  missing: string | undefined;
  lacks(name: string): void;
}
interface CellRunner {
  /** Outputs in JSON; nothing where a package is missing. */
  run_in_page(source: string): string | undefined;
  missing: string;
  lacks(name: string): void;
}
interface Pyodide {
  loadPackage(names: string[], options?: object): Promise<unknown>;
  unpackArchive(data: Uint8Array, format: string, options: object): void;
  runPython(code: string): unknown;
  /** A typed array as a view of memory. */
  toPy(data: Uint8Array): unknown;
  lockfile: { packages: Record<string, Package> };
  _api: { config: { cdnUrl: string } };
}

/** What the other worker is sent and sends; what the page is sent. */
type Sent = { task: Uint8Array } | { kind: string; bytes: Uint8Array };

/** Without a message for so long, what follows from the last one is computed, ms. */
const PAUSE = 200;
/** Balancing needs the solver late, and would begin again: it is loaded with what comes before. */
const SOLVER = { name: "clarabel", after: "scipy" };

const base = new URL(".", self.location.href);
const post = (content: unknown, bytes?: Uint8Array): void =>
  (self as unknown as Worker).postMessage(content, bytes ? [bytes.buffer] : []);

/** Post which files have been loaded since the last time. */
function tellLoaded(): void {
  post({ type: "loaded", files: performance.getEntriesByType("resource").map(({ name }) => name) });
  performance.clearResourceTimings();
}

/** A copy of Python's bytes; what held them is given back. */
function own(bytes: Bytes): Uint8Array {
  const copy = bytes.toJs().slice();
  bytes.destroy();
  return copy;
}

/** Let messages in between two steps. */
const channel = new MessageChannel();
let turn: (() => void) | null = null;
channel.port1.onmessage = () => turn?.();
const others = (): Promise<void> =>
  new Promise((done) => {
    turn = done;
    channel.port2.postMessage(0);
  });

/** What is fetched from now on is unpacked where it lies there compressed, as many hosts compress nothing. */
function unpacking(packed: string[]): void {
  const fetchAsItIs = self.fetch.bind(self);
  const compressed = new Set(packed.map((path) => new URL(path, base).href));
  self.fetch = async (resource, options) => {
    const address = new URL(resource instanceof Request ? resource.url : resource, base).href;
    if (!compressed.has(address)) return fetchAsItIs(resource, options);
    const reply = await fetchAsItIs(`${address}.gzip`, options);
    if (!reply.ok || !reply.body) return reply;
    const type = address.endsWith(".wasm") ? "application/wasm" : "application/octet-stream";
    return new Response(reply.body.pipeThrough(new DecompressionStream("gzip")), { headers: { "Content-Type": type } });
  };
}

/** What a script gives that may lie there compressed, which a browser does not import from its place. */
async function imported(address: URL): Promise<unknown> {
  const reply = await fetch(address);
  if (!reply.ok) throw new Error(`${address.pathname}: ${reply.status}`);
  const script = URL.createObjectURL(new Blob([await reply.arrayBuffer()], { type: "text/javascript" }));
  try {
    return ((await import(script)) as { default: unknown }).default;
  } finally {
    URL.revokeObjectURL(script);
  }
}

async function start(
  kind: "worker.Foreground" | "worker.Background" | "cells.CellRunner",
): Promise<[Pyodide, unknown]> {
  const site = (await (await fetch(new URL("site.json", base))).json()) as Site;
  unpacking(site.packed);
  const runtime = new URL(site.runtime, base);
  const { loadPyodide } = (await import(new URL("pyodide.mjs", runtime).href)) as {
    loadPyodide(options: object): Promise<Pyodide>;
  };
  const program = imported(new URL("pyodide.asm.mjs", runtime));
  const fetched = site.own.map(async (path) => {
    const reply = await fetch(new URL(path, base));
    if (!reply.ok) throw new Error(`${path}: ${reply.status}`);
    return new Uint8Array(await reply.arrayBuffer());
  });
  const { lock, first } = site;
  const here = ({ file_name }: Package): boolean => file_name.includes("/");
  for (const item of Object.values(lock.packages)) if (here(item)) item.file_name = new URL(item.file_name, base).href;
  const python = await loadPyodide({
    indexURL: runtime.href,
    createPyodideModule: await program,
    lockFileContents: lock,
    packages: first.filter((name) => here(lock.packages[name] as Package)), // while the runtime starts
    stdout: () => undefined,
  });
  // The others come from where the runtime's own packages are published, and are checked as well.
  const published = python._api.config.cdnUrl;
  for (const item of Object.values(python.lockfile.packages))
    if (!here(item)) item.file_name = published + item.file_name;
  await python.loadPackage(first, { messageCallback: () => undefined });
  // Beside the others: texts of a language are laid over what stands in for them.
  const extractDir = python.runPython("import sysconfig; sysconfig.get_path('purelib')");
  for (const data of await Promise.all(fetched)) python.unpackArchive(data, "wheel", { extractDir });
  const [module, name] = kind.split(".");
  const code = `from equipoise.web.${module} import ${name}; ${name}()`;
  return [python, python.runPython(code)];
}

/** What has been loaded: if a module is still missing then, asking for it again leads nowhere. */
const requested = new Set<string>();

/** Load the package that has a module; returns whether that succeeded. */
async function load(python: Pyodide, module: string): Promise<boolean> {
  if (requested.has(module)) return false;
  requested.add(module);
  const packages = Object.entries(python.lockfile.packages);
  const wanted = packages.find(([name, { imports }]) => name === module || imports.includes(module));
  if (!wanted) return false;
  const [name, { imports }] = wanted;
  post({ type: "loading", what: name });
  try {
    await python.loadPackage([name], { messageCallback: () => undefined });
    python.runPython("import importlib; importlib.invalidate_caches()");
    if (imports.length) python.runPython(`import ${module}`); // texts of a language have nothing to import
    return true;
  } catch {
    return false;
  } finally {
    post({ type: "loading", what: null });
    tellLoaded();
  }
}

async function foreground(): Promise<void> {
  const early: string[] = [];
  self.onmessage = ({ data }: MessageEvent<string>) => early.push(data);
  const [python, page] = (await start("worker.Foreground")) as [Pyodide, Foreground];
  tellLoaded();
  /** It starts once the first machine is shown, so that this one has the processor to itself until then. */
  let other: Worker | null = null;
  const hand = (task: Uint8Array): void => {
    other ??= begin();
    other.postMessage({ task });
  };
  let [busy, timer, shown] = [false, 0, false];

  function begin(): Worker {
    const worker = new Worker(self.location.href, { type: "module", name: "background" });
    worker.onmessage = ({ data }: MessageEvent<Sent | { type: string }>) => {
      if ("type" in data) return post(data);
      if (!("kind" in data)) return;
      if (data.kind === "result") page.result_of_task(python.toPy(data.bytes));
      else if (page.wants_reply()) post(data.bytes, data.bytes);
      void work();
    };
    return worker;
  }

  function answer(reply: Bytes): void {
    const bytes = own(reply);
    post(bytes, bytes);
    shown = true;
  }

  async function work(): Promise<void> {
    if (busy) return;
    busy = true;
    clearTimeout(timer);
    for (;;) {
      const reply = page.step();
      while (page.tasks.length) hand(own(page.tasks.popleft()));
      if (reply) answer(reply);
      else if (page.missing) {
        const module = page.missing;
        if (!(await load(python, module))) page.lacks(module);
      } else break;
      await others();
    }
    busy = false;
    if (shown) other ??= begin();
    timer = self.setTimeout(() => {
      if (page.rest()) return void work();
      while (page.tasks.length) hand(own(page.tasks.popleft()));
    }, PAUSE);
  }

  self.onmessage = ({ data }: MessageEvent<string>) => {
    if (data === "cancel") {
      other?.terminate();
      other = begin();
      post({ type: "loading", what: null });
      page.cancel();
    } else page.take(data);
    void work();
  };
  for (const text of early) page.take(text);
  void work();
}

/** What is sent to this worker, one after the other. */
function inbox<Sent>(): () => Promise<Sent> {
  const waiting: Sent[] = [];
  let wake: (() => void) | null = null;
  self.onmessage = ({ data }: MessageEvent<Sent>) => {
    waiting.push(data);
    wake?.();
  };
  return async () => {
    while (!waiting.length) await new Promise<void>((done) => (wake = done));
    return waiting.shift() as Sent;
  };
}

async function cells(): Promise<void> {
  const next = inbox<string>();
  const [python, page] = (await start("cells.CellRunner")) as [Pyodide, CellRunner];
  for (;;) {
    const source = await next();
    let outputs = page.run_in_page(source);
    while (outputs === undefined) {
      const module = page.missing;
      if (!(await load(python, module))) page.lacks(module);
      outputs = page.run_in_page(source);
    }
    post({ type: "ran", outputs });
  }
}

async function background(): Promise<void> {
  const next = inbox<{ task: Uint8Array }>();
  const [python, tasks] = (await start("worker.Background")) as [Pyodide, Background];
  for (;;) {
    const { task } = await next();
    tasks.begin(python.toPy(task));
    for (let done = false; !done; ) {
      const step = tasks.step();
      if (step) {
        const bytes = own(step.get(1));
        const kind = step.get(0);
        step.destroy();
        post({ kind, bytes }, bytes);
        done = kind === "result";
      } else if (tasks.missing) {
        const module = tasks.missing;
        if (!(await load(python, module))) tasks.lacks(module);
        else if (SOLVER.after === module) await load(python, SOLVER.name);
        tasks.begin(python.toPy(task));
      }
    }
  }
}

const failed = (error: unknown): void => post({ type: "failed", what: String(error) });
const ROLES: Record<string, () => Promise<void>> = { background, cells };
(ROLES[self.name] ?? foreground)().catch(failed);
