// What is in the file, and the engine behind a worker or on the page itself.
import { serve } from "./engine.js";

export function elementText(id) {
  const found = document.getElementById(id);
  if (!found) throw new Error(`the file has no part “${id}”: it was cut short. Make or copy it again`);
  return found.textContent;
}

export async function unpack(id) {
  const text = elementText(id);
  let packed;
  try { packed = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)); } catch {
    throw new Error(`part “${id}” of the file is damaged. Make or copy it again`);
  }
  if (typeof DecompressionStream === "undefined") {
    throw new Error("this browser cannot unpack the file (no DecompressionStream): take Chromium 80, Firefox 113, Safari 16.4 or newer");
  }
  try {
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
  } catch {
    throw new Error(`part “${id}” of the file is damaged. Make or copy it again`);
  }
}

// A module of one function with a vector in it: what has no vectors refuses it.
const VECTORS = [0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11];

export function missing() {
  if (typeof WebAssembly === "undefined") {
    return "This browser runs no WebAssembly, in which the bearing is stepped. Take a newer one, or allow WebAssembly where it was switched off.";
  }
  if (!WebAssembly.validate(Uint8Array.from(VECTORS))) {
    return "This browser has no vectors in WebAssembly (SIMD), with which the bearing is stepped. Take Chromium 91, Firefox 89, Safari 16.4 or newer.";
  }
  return null;
}

// The engine: `send` gives it tasks, `receive` gets what it says.
export function startEngine(receive, inWorker) {
  if (inWorker && typeof Worker !== "undefined") {
    try {
      const text = `${elementText("engine")}\nconst told = new MessageChannel(); let waiting = null;
        told.port1.onmessage = () => waiting();
        const answer = serve((m, t) => postMessage(m, t), () => performance.now(), (f) => { waiting = f; setTimeout(() => told.port2.postMessage(0), 0); });
        onmessage = (event) => answer(event.data);`;
      const worker = new Worker(URL.createObjectURL(new Blob([text], { type: "text/javascript" })));
      worker.onmessage = (event) => receive(event.data);
      worker.onerror = (event) => receive({ kind: "stopped", why: event.message || "the worker has ended" });
      return { send: (message, transfer) => worker.postMessage(message, transfer || []), worker: true };
    } catch { /* Some browsers let no file start a worker: the page steps by itself. */ }
  }
  const answer = serve((message) => setTimeout(() => receive(message), 0), () => performance.now(), (f) => setTimeout(f, 4));
  return { send: (message) => answer(message), worker: false };
}
