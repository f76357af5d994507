/** Keeps a site for use offline: what was loaded once is answered from the browser's own store. */

interface Extended extends Event {
  waitUntil(done: Promise<unknown>): void;
}
interface Fetched extends Extended {
  request: Request;
  respondWith(reply: Promise<Response>): void;
}
interface Messaged extends Extended {
  data: string[];
}
interface Scope {
  addEventListener(type: "install" | "activate", heard: (event: Extended) => void): void;
  addEventListener(type: "fetch", heard: (event: Fetched) => void): void;
  addEventListener(type: "message", heard: (event: Messaged) => void): void;
  skipWaiting(): Promise<void>;
  clients: { claim(): Promise<void> };
}

const scope = self as unknown as Scope;
/** Each build of a site has an address of its own for this script, so a new one gets a new store. */
const STORE = `equipoise ${new URL(self.location.href).searchParams.get("build") ?? ""}`;

scope.addEventListener("install", (event) => event.waitUntil(scope.skipWaiting()));

scope.addEventListener("activate", (event) => {
  const clean = async (): Promise<void> => {
    const old = (await caches.keys()).filter((name) => name.startsWith("equipoise ") && name !== STORE);
    await Promise.all(old.map((name) => caches.delete(name)));
    await scope.clients.claim();
  };
  event.waitUntil(clean());
});

async function kept(request: Request): Promise<Response> {
  const store = await caches.open(STORE);
  const known = await store.match(request);
  // Pages may be newer on the host; everything else belongs to this build.
  if (known && request.mode !== "navigate") return known;
  try {
    const reply = await fetch(request);
    if (reply.ok) await store.put(request, reply.clone());
    return reply;
  } catch (error) {
    if (known) return known;
    throw error;
  }
}

scope.addEventListener("fetch", (event) => {
  if (event.request.method === "GET") event.respondWith(kept(event.request));
});

/** Keep what was loaded before this worker began; the browser's own cache has most of it still. */
async function keep(addresses: string[]): Promise<void> {
  const store = await caches.open(STORE);
  for (const address of addresses) {
    if (await store.match(address)) continue;
    const reply = await fetch(address, { cache: "force-cache" }).catch(() => null);
    if (reply?.ok) await store.put(address, reply);
  }
}

scope.addEventListener("message", (event) => event.waitUntil(keep(event.data)));
