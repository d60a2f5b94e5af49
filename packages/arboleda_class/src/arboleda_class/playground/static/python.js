// Python in a worker: requests, one after the other, each with a promise of its answer.

// `step` hears what is loaded meanwhile. `end` ends Python, whatever it does; what is asked then fails.
export function begin(step) {
  const worker = new Worker(new URL("./worker.js", import.meta.url), { type: "module" });
  const waiting = new Map(); // number -> {done, failed, progress}
  let last = 0;

  worker.onmessage = ({ data: { number, answer, broken, step: loaded, share } }) => {
    if (loaded) return step(loaded);
    const { done, failed, progress } = waiting.get(number);
    if (share !== undefined) return progress(share);
    waiting.delete(number);
    broken === undefined ? done(answer) : failed(new Error(broken));
  };
  worker.onerror = (event) => fail(event.message || "worker");

  function fail(why) {
    for (const { failed } of waiting.values()) failed(new Error(why));
    waiting.clear();
  }

  return {
    ask(what, request = {}, progress = () => {}) {
      const number = ++last;
      worker.postMessage({ number, request: { do: what, ...request } });
      return new Promise((done, failed) => waiting.set(number, { done, failed, progress }));
    },
    end() {
      worker.terminate();
      fail("stopped");
    },
  };
}
