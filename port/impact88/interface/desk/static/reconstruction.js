// The Reconstruction view: what is known is ticked, the rest is solved for while one types.
import { ask, asked, attempt, drawInto, page, save, settled, showList, showUnits, tell, watched } from "./ask.js";

const form = () => page("reconstruction-form");
const inputs = () => [...form().querySelectorAll("input[name]")];
const ticks = () => [...form().querySelectorAll("input[data-for]")];
const tickOf = (input) => page(`${input.id}-known`);
const toleranceOf = (input) => page(`${input.id}-tolerance`);
const WITHIN = /^(.*\S)\s*(?:\+-|±)\s*(\S.*)$/;
let extra = {}; // what a file has beside the fields: computed with, and saved again
const question = () => ({ values: { ...extra, ...values() }, units: page("reconstruction-units").value });
const trouble = (error) => tell(page("reconstruction-trouble"), error);

/** The values that count: those always known, and those ticked. */
function values() {
  const counted = inputs().filter((input) => input.value.trim() && tickOf(input)?.checked !== false);
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

/** What is wrong with each value, at its field. */
function showProblems(problems) {
  tell(page("reconstruction-units-problem"), problems.units && { message: problems.units });
  for (const input of inputs()) {
    const problem = problems[input.name];
    tell(page(`${input.id}-problem`), problem && { message: problem });
    if (problem) input.setAttribute("aria-invalid", "true");
    else input.removeAttribute("aria-invalid");
  }
}

/** The values solved for, at the fields they belong to. */
function showAtFields(solutions) {
  for (const input of inputs()) {
    const place = page(`${input.id}-answer`);
    const texts = solutions.map(({ rows }) => rows.find((row) => row.name === input.name && !row.known))
      .filter(Boolean).map((row) => (row.columns["±"] ? `${row.text} ± ${row.columns["±"]}` : row.text));
    place.hidden = !texts.length || tickOf(input)?.checked !== false;
    place.textContent = texts.length ? `solved: ${[...new Set(texts)].join(" or ")}` : "";
  }
}

/** The drawing of a solution, and a button that takes it over to the Collision view. */
function finish(part, solution, units) {
  if (!solution.scene) return;
  const scene = { values: solution.scene, title: "Reconstructed", units, extra };
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
  showProblems(told.problems);
  showList(page("reconstruction-remarks"), told.remarks);
  showUnits(form(), told.units);
  latest = told.solutions;
  const whole = told.solutions.length > 0;
  page("reconstruction-waiting").textContent = told.waiting;
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

function load(given) {
  extra = given.extra ?? {};
  for (const input of inputs()) {
    put(input, given.values[input.name] ?? "");
    const tick = tickOf(input);
    if (tick) tick.checked = Boolean(input.value);
  }
  page("reconstruction-units").value = given.units ?? "";
  const more = page("reconstruction-more");
  more.open ||= inputs().some((input) => more.contains(input) && input.value);
  answer();
}

const doing = (work) => attempt(work, trouble);

/** Start the view. */
export function reconstruction() {
  form().addEventListener("input", (event) => {
    const { target } = event;
    const tick = target.name ? tickOf(target) : null;
    if (tick) tick.checked = Boolean(target.value.trim());
    answer();
  });
  form().addEventListener("submit", (event) => event.preventDefault());
  page("reconstruction-sample").addEventListener("change", (event) => {
    const number = event.target.value;
    event.target.value = "";
    if (number) doing(async () => load(await asked(`known/${number}`)));
  });
  page("reconstruction-units").addEventListener("change", answer);
  page("reconstruction-open").addEventListener("click", () => page("reconstruction-file").click());
  page("reconstruction-file").addEventListener("change", (event) => {
    const [file] = event.target.files;
    if (!file) return;
    doing(async () => {
      load(await asked("known", file, { name: file.name }));
      page("reconstruction-file").value = "";
    });
  });
  page("reconstruction-save").addEventListener("click", () => doing(async () =>
    save(await ask("file/reconstruction", question()))));
  page("reconstruction-report").addEventListener("click", () => doing(async () => {
    const busy = page("reconstruction-busy");
    const response = await watched(busy, "Writing the report", "bounds", ask("case-report/reconstruction", question()));
    if (response) await save(response);
  }));
  page("reconstruction-print").addEventListener("click", () => print());
  showTicks();
}
