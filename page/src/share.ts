/** A model in the fragment of an address: deflated, in base64 for addresses; no server reads it. */

/** Most signs of an address that messengers and browsers pass on whole. */
export const LONGEST = 30_000;

export interface Shared {
  name: string;
  text: string;
  /** Texts of the tables that it names. */
  files?: Record<string, string>;
}

/** The part behind the `#`, without it. */
export async function fragment({ name, text, files = {} }: Shared): Promise<string> {
  const tables = Object.keys(files).length > 0 && { tables: await packed(JSON.stringify(files)) };
  return new URLSearchParams({ name, model: await packed(text), ...tables }).toString();
}

async function packed(text: string): Promise<string> {
  const stream = new Blob([text]).stream().pipeThrough(new CompressionStream("deflate"));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  let signs = "";
  for (const byte of bytes) signs += String.fromCharCode(byte);
  return btoa(signs).replace(/\+/g, "-").replace(/\//g, "_").replace(/=/g, "");
}

/** What a fragment holds, and an error where that is no whole model. */
export async function read(hash: string, largest: number): Promise<Shared> {
  const found = new URLSearchParams(hash.replace(/^#/, ""));
  const [model, tables] = [found.get("model"), found.get("tables")];
  if (!model) throw new RangeError();
  const name = found.get("name") ?? "machine.toml";
  const files = tables && (JSON.parse(await unpacked(tables, largest)) as Record<string, string>);
  return { name, text: await unpacked(model, largest), ...(files && { files }) };
}

async function unpacked(packed: string, largest: number): Promise<string> {
  const signs = atob(packed.replace(/-/g, "+").replace(/_/g, "/"));
  const bytes = Uint8Array.from(signs, (sign) => sign.charCodeAt(0));
  return text(slowly(bytes).pipeThrough(new DecompressionStream("deflate")), largest);
}

/** Signs that are unpacked at a time: browsers unpack all that they are given, up to a thousandfold. */
const PIECE = 1024;

/** Bytes of which no more are handed on than are asked for. */
function slowly(bytes: Uint8Array<ArrayBuffer>): ReadableStream<Uint8Array<ArrayBuffer>> {
  let at = 0;
  const pull = (to: ReadableStreamDefaultController<Uint8Array<ArrayBuffer>>) => {
    to.enqueue(bytes.slice(at, (at += PIECE)));
    if (at >= bytes.length) to.close();
  };
  return new ReadableStream({ pull }, { highWaterMark: 0 });
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
    if (size > largest) {
      await reader.cancel();
      throw new RangeError();
    }
    found += decoder.decode(value, { stream: true });
  }
}
