// What the editor of trees shows now, and how nodes are found in it: by paths, `root`, `0`, `0.1`.

import * as make from "./make_state.js";

// A tree that does nothing yet, and that the check has nothing to object to.
export const NEW = '<?xml version="1.0" encoding="UTF-8"?>\n<root BTCPP_format="4" main_tree_to_execute="Main">\n  <BehaviorTree ID="Main">\n    <Sequence>\n      <AlwaysSuccess/>\n    </Sequence>\n  </BehaviorTree>\n</root>\n';

export const state = { cell: null, file: "", files: [], kinds: new Map(), past: [], now: null, future: [], saved: null, tree: null, path: "root", how: "into" };

export const box = (id) => document.getElementById(`draw-${id}`);
export const tree = () => state.now?.trees.find(({ name }) => name === state.tree);
export const node = (path = state.path) => tree()?.nodes.find((each) => each.path === path);
export const kindOf = (name) => state.kinds.get(name);
export const say = (sentence) => (box("note").textContent = sentence ?? "");
export const parentOf = (path) => (path === "root" ? null : path.includes(".") ? path.slice(0, path.lastIndexOf(".")) : "root");
export const indexOf = (path) => Number(path.slice(path.lastIndexOf(".") + 1));
export const childPath = (path, index) => (path === "root" ? `${index}` : `${path}.${index}`);
export const childrenOf = (path) => tree().nodes.filter((each) => parentOf(each.path) === path);
export const ask = (path, body) => make.ask(path, body, say);
