// The Reconstruction view: what is known is ticked, the rest is solved for while one types.
import { amount, ask, asked, attempt, drawInto, element, fill, page, save, settled, showUnits, tell, watched, what } from "./ask.js";

const form = () => page("reconstruction-form");
const inputs = () => [...form().querySelectorAll("input[name]")];
const ticks = () => [...form().querySelectorAll("input[data-for]")];
const tickOf = (input) => page(`${input.id}-known`);
const toleranceOf = (input) => page(`${input.id}-tolerance`);
const WITHIN = /^(.*\S)\s*(?:\+-|±)\s*(\S.*)$/;
let extra = {}; // lengths and widths from a file: drawn, and saved again
const question = () => ({ values: values(), units: page("reconstruction-units").value });
const trouble = (error) => tell(page("reconstruction-trouble"), error);

/** The question with what stands beside the form. */
const whole = () => ({ ...question(), values: { ...extra, ...values() } });

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

function tableOf(name, heads, rows, classOf) {
  const table = element("table", {});
  fill(table, name, heads, rows, classOf);
  return element("div", { className: "scroll", tabIndex: 0, role: "region", "aria-label": name }, table);
}

const ASKED = ["DVA", "DVB", "LOSS"]; // shown with what was solved for

function solutionPart(solution, at, count) {
  const parts = [];
  if (count > 1) parts.push(element("h2", {}, `Solution ${at + 1} of ${count}`));
  if (solution.warnings.length) {
    parts.push(element("div", { className: "warnings" }, element("h2", {}, "Warnings"),
      element("ul", {}, ...solution.warnings.map((text) => element("li", {}, text)))));
  }
  const columns = solution.columns;
  const table = (name, rows) => tableOf(name, ["name", "what", "value", ...columns], rows.map((row) =>
    [row.name, what(row), amount(row.text, row.value, row.name, row.unit), ...columns.map((column) =>
      amount(row.columns[column] ?? "", row.numbers[column], `${row.name} ${column}`, row.unit))]),
  (place) => (rows[place].solved ? "solved" : ""));
  parts.push(table("What follows", solution.rows.filter((row) => row.solved || ASKED.includes(row.name))));
  if (solution.adjusted.length) {
    parts.push(element("h2", {}, "What was measured, and how it was adjusted"),
      tableOf("Adjusted", ["name", "what", "measured", "±", "adjusted", "moved, tolerances"], solution.adjusted.map((row) =>
        [row.name, what(row), row.measured, row.tolerance, row.adjusted, row.moved])));
  }
  if (solution.scene) {
    const picture = element("img", { alt: "" });
    const figure = element("figure", { className: "sheet", hidden: true }, picture);
    const scene = { values: solution.scene, title: "Reconstructed", units: solution.units, extra };
    drawInto(picture, { ...scene, values: { ...extra, ...solution.scene } }).then((drawn) => { figure.hidden = !drawn; });
    const button = element("button", { type: "button" }, "Open this collision");
    button.addEventListener("click", () => {
      dispatchEvent(new CustomEvent("desk-scene", { detail: scene }));
      location.hash = "#collision";
    });
    // the drawing comes later: what stands above it does not move
    parts.push(element("p", { className: "over" }, button), figure);
  }
  parts.push(element("details", {}, element("summary", {}, "All that follows"),
    table("All that follows", solution.rows.filter((row) => !row.known))));
  parts.push(element("details", {}, element("summary", {}, "As impact88 reconstruct prints it"),
    element("pre", { className: "plain", tabIndex: 0, role: "region", "aria-label": "As printed" }, solution.printed)));
  return element("div", { className: "solution" }, ...parts);
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
  showUnits(form(), told.units);
  latest = told.solutions;
  const whole = told.solutions.length > 0;
  page("reconstruction-waiting").textContent = told.waiting;
  page("reconstruction-answer").classList.toggle("stale", !whole);
  showAtFields(told.solutions);
  if (!whole) return;
  page("reconstruction-answer").hidden = false;
  page("reconstruction-answer").replaceChildren(...told.solutions.map((solution, at) =>
    solutionPart({ ...solution, units: told.units.name }, at, told.solutions.length)));
  announce();
}, 200);

function answer() {
  showTicks();
  solve();
}

function load(given) {
  extra = given.extra ?? {};
  tell(page("reconstruction-remarks"), given.remarks?.length && { message: given.remarks.join(" ") });
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
    save(await ask("known-file", whole()))));
  page("reconstruction-report").addEventListener("click", () => doing(async () => {
    const busy = page("reconstruction-busy");
    const response = await watched(busy, "Writing the report", "bounds", ask("case-report/reconstruction", whole()));
    if (response) await save(response);
  }));
  page("reconstruction-print").addEventListener("click", () => print());
  showTicks();
}
