// The OEE of the cells, of the hours that somebody chose.

import { apply } from "../live.js";

const { language } = window.arboledaPage;
const EVERY_MS = 60_000;
let asked = 0;

const hours = () => document.getElementById("oee-hours");
const seen = () => !document.getElementById("part-tasks").hidden;

export function start() {
  hours().addEventListener("change", show);
  setInterval(() => seen() && show(), EVERY_MS);
}

export function arrive({ tab }) {
  if (tab === "tasks") show();
}

async function show() {
  const number = ++asked;
  const query = new URLSearchParams({ hours: hours().value, lang: language });
  const answer = await fetch(`/oee.json?${query}`).catch(() => null);
  const rows = answer?.ok ? await answer.json() : null;
  if (number === asked && rows) apply(rows);
}
