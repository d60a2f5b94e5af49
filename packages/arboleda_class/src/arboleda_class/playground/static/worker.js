// The worker of a tab: Python in WebAssembly, which hears requests of the page and answers each of them.

import { loadPyodide } from "./pyodide/pyodide.mjs";

const WHEELS = "./python/wheels.json"; // what is unpacked, beside the standard library

async function begin() {
  const told = (step) => postMessage({ step });
  told("python");
  const names = await (await fetch(WHEELS)).json();
  const [python, ...archives] = await Promise.all([loadPyodide({ indexURL: new URL("./pyodide/", import.meta.url).href }), ...names.map(archive)]);
  told("arboleda");
  for (const [number, each] of archives.entries()) python.unpackArchive(each, names[number].endsWith(".whl") ? "wheel" : "zip", { extractDir: python.runPython("import site; site.getsitepackages()[0]") });
  return python.runPython("from arboleda_class.playground.tab import hear; hear");
}

async function archive(name) {
  const answer = await fetch(`./python/${name}`);
  if (!answer.ok) throw new Error(`${name}: ${answer.status}`);
  return new Uint8Array(await answer.arrayBuffer());
}

const ready = begin();

onmessage = async ({ data: { number, request } }) => {
  try {
    const hear = await ready;
    postMessage({ number, answer: JSON.parse(hear(JSON.stringify(request), (share) => postMessage({ number, share }))) });
  } catch (error) {
    postMessage({ number, broken: String(error.message ?? error).trim().split("\n").at(-1) });
  }
};
