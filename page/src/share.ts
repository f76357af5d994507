/** A model in the fragment of an address: deflated, in base64 for addresses; no server reads it. */

/** Most signs of an address that messengers and browsers pass on whole. */
export const LONGEST = 30_000;

export interface Shared {
  name: string;
  text: string;
}

/** The part behind the `#`, without it. */
export async function fragment({ name, text }: Shared): Promise<string> {
  const stream = new Blob([text]).stream().pipeThrough(new CompressionStream("deflate"));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  let signs = "";
  for (const byte of bytes) signs += String.fromCharCode(byte);
  const model = btoa(signs).replace(/\+/g, "-").replace(/\//g, "_").replace(/=/g, "");
  return new URLSearchParams({ name, model }).toString();
}

/** What a fragment holds; null where it holds no model, and an error where it is damaged. */
export async function read(hash: string, largest: number): Promise<Shared | null> {
  const found = new URLSearchParams(hash.replace(/^#/, ""));
  const model = found.get("model");
  if (!model) return null;
  const signs = atob(model.replace(/-/g, "+").replace(/_/g, "/"));
  const bytes = Uint8Array.from(signs, (sign) => sign.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return { name: found.get("name") ?? "machine.toml", text: await text(stream, largest) };
}

/** A few bytes can swell to any size: nothing is read beyond what a model may have. */
async function text(stream: ReadableStream<Uint8Array>, largest: number): Promise<string> {
  const reader = stream.getReader();
  const decoder = new TextDecoder("utf-8", { fatal: true });
  let [found, size] = ["", 0];
  for (;;) {
    const { done, value } = await reader.read();
    if (done) return found + decoder.decode();
    size += value.length;
    if (size > largest) throw new RangeError();
    found += decoder.decode(value, { stream: true });
  }
}
