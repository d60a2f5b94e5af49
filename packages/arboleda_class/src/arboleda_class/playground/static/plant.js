// The plant in the worker, and what the page's own scripts ask of a server.

import { begin } from "./python.js";

// A workbook has this page in a frame, and has built the plant in a worker of its own.
const within = new URLSearchParams(location.search).has("within");
let steps = () => {};
const python = within ? window.parent.arboledaPython : begin((step) => steps(step));

export const onStep = (call) => (steps = call);
export const ask = (what, request = {}) => python.ask(what, request);

// What the page's scripts fetch from the server of a plant; anything else is a file of this site.
const SERVED = [
  [/^\/twin\/scene\.json$/, async () => (await ask("scene")).scene],
  [/^\/task\.json$/, async (address) => (await ask("task_face", { id: address.searchParams.get("id") })).face],
  [/^\/api\/(?:cells\/)?([^/]+)\/stop$/, (address, stop) => stop(address.pathname.startsWith("/api/plant/") ? "" : decodeURIComponent(address.pathname.split("/")[3]))],
];

// `tell` gets what buttons ask for: (event, act, of, more), as NiceGUI's socket would.
export function serve(tell) {
  const files = window.fetch.bind(window);
  window.fetch = async (resource, options) => {
    const address = new URL(resource.url ?? resource, location.href);
    const found = SERVED.find(([path]) => address.origin === location.origin && path.test(address.pathname));
    if (!found) return files(resource, options);
    const said = await found[1](address, async (of) => (await tell("arboleda", "stop", of, false), {}));
    return new Response(JSON.stringify(said), { headers: { "Content-Type": "application/json" } });
  };
  window.socket = { connected: true, on() {} }; // it is never lost, so there is nothing to hear of it
  window.did_handshake = true;
  window.emitEvent = tell;
}
