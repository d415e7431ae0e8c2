// The Reconstruction view: what is known is ticked, the rest is solved for while one types.
import { asked, drawInto, page, settled, showList, showUnits, watched } from "./ask.js";
import { formView } from "./form.js";

const view = formView("reconstruction", {
  file: "known",
  read: values,
  put,
  answer: () => answer(),
  loaded: showAll,
});
const { form, inputs, question, trouble } = view;
const ticks = () => [...form().querySelectorAll("input[data-for]")];
const tickOf = (input) => page(`${input.id}-known`);
const toleranceOf = (input) => page(`${input.id}-tolerance`);
const WITHIN = /^(.*\S)\s*(?:\+-|±)\s*(\S.*)$/;

/** The values that count: those always known, and those ticked; or `all` that stand there. */
function values(all = false) {
  const counted = inputs().filter((input) => input.value.trim() && (all || tickOf(input)?.checked !== false));
  return Object.fromEntries(counted.map((input) => [input.name, textOf(input)]));
}

/** A value with its tolerance, as a file has it. */
function textOf(input) {
  const tolerance = toleranceOf(input)?.value.trim();
  return tolerance ? `${input.value.trim()} +- ${tolerance}` : input.value;
}

function put(input, text) {
  const within = toleranceOf(input) && WITHIN.exec(text);
  input.value = within ? within[1] : text;
  if (toleranceOf(input)) toleranceOf(input).value = within ? within[2] : "";
}

function showTicks() {
  for (const tick of ticks()) tick.closest(".knowable").classList.toggle("unknown", !tick.checked);
}

/** The values solved for, at the fields they belong to. */
function showAtFields(solutions) {
  for (const input of inputs()) {
    const place = page(`${input.id}-answer`);
    const texts = solutions.map(({ rows }) => rows.find((row) => row.name === input.name && !row.known))
      .filter(Boolean).map((row) => (row.columns.sd ? `${row.text}, sd ${row.columns.sd}` : row.text));
    place.hidden = !texts.length || tickOf(input)?.checked !== false;
    place.textContent = texts.length ? `solved: ${[...new Set(texts)].join(" or ")}` : "";
  }
}

/** The drawing of a solution, and a button that takes it over to the Collision view. */
function finish(part, solution, units) {
  if (!solution.scene) return;
  const extra = view.beside();
  const scene = { values: solution.scene, title: extra.title || "Reconstructed", units, extra };
  drawInto(part.querySelector("img"), { ...scene, values: { ...extra, ...solution.scene } })
    .then((drawn) => { part.querySelector("figure").hidden = !drawn; });
  part.querySelector("button").addEventListener("click", () => {
    dispatchEvent(new CustomEvent("desk-scene", { detail: scene }));
    location.hash = "#collision";
  });
}

let latest = [];
const announce = settled(() => {
  page("reconstruction-said").textContent = latest.map(({ rows }) => rows.filter((row) => row.solved)
    .map((row) => `${row.meaning}: ${row.text}`).join(", ")).join("; or ");
}, 1200);

// a newer question ends the one before, so that each is asked at once
let asking = 0;
const solve = settled(async () => {
  const mine = (asking += 1);
  page("reconstruction-waiting").textContent = "Computing …";
  let told;
  try {
    told = await watched(page("reconstruction-busy"), "Computing", "reconstruction", asked("reconstruct", question()));
  } catch (error) {
    page("reconstruction-waiting").textContent = "";
    trouble(error);
    return;
  }
  if (!told) { // a newer question says what it finds
    if (mine === asking) page("reconstruction-waiting").textContent = "Stopped.";
    return;
  }
  trouble(null);
  view.showProblems(told.problems);
  showList(page("reconstruction-remarks"), told.remarks);
  showUnits(form(), told.units);
  latest = told.solutions;
  const whole = told.solutions.length > 0;
  const open = inputs().filter((input) => input.placeholder && !input.value.trim()).map((input) => input.name);
  const fillIn = open.length && !whole ? `Still to fill in: ${open.join(" ")}.` : "";
  page("reconstruction-waiting").textContent = fillIn || told.waiting;
  page("reconstruction-answer").classList.toggle("stale", !whole);
  showAtFields(told.solutions);
  if (!whole) return;
  page("reconstruction-answer").hidden = false;
  page("reconstruction-answer").innerHTML = told.tables;
  page("reconstruction-answer").querySelectorAll(".solution").forEach((part, at) =>
    finish(part, told.solutions[at], told.units.name));
  announce();
}, 200);

function answer() {
  showTicks();
  solve();
}

/** Tick what a file has, and open the part of the form that it fills or that is to be filled in. */
function showAll() {
  for (const tick of ticks()) tick.checked = Boolean(page(tick.id.replace(/-known$/, "")).value);
  const more = page("reconstruction-more");
  more.open ||= inputs().some((input) => more.contains(input) && (input.value || input.placeholder));
}

/** Start the view. */
export function reconstruction() {
  view.start();
  form().addEventListener("input", (event) => {
    const { target } = event;
    if (target.dataset.about) return;
    const tick = target.name ? tickOf(target) : null;
    if (tick) tick.checked = Boolean(target.value.trim());
    answer();
  });
  showTicks();
}
